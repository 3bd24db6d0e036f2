#include "physics/vortex/KernelLaws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kiln {
namespace {

/// q and dq/d(r²) of Lamb–Oseen in units of δ, with 64 bits.
long double lamb_oseen_value(long double z) { return -std::expm1(-z) / z; }
long double lamb_oseen_slope(long double z) {
  if (z < 1e-4L) return -0.5L + z / 3 - z * z / 8 + z * z * z / 30;
  return (std::exp(-z) - lamb_oseen_value(z)) / z;
}

TEST(LambOseenLaw, SlopeIsRightWhereItsTermsCancel) {
  for (const double core : {1.0, 0.05, 7.0}) {
    const LambOseenLaw law(core);
    for (double z = 1e-18; z < 1e5; z *= 1.37) {
      const double s = z * core * core;
      const KernelSlope<double> q = law.slope(s + law.offset());
      const double value = static_cast<double>(lamb_oseen_value(z)) / (core * core);
      const double slope = static_cast<double>(lamb_oseen_slope(z)) / std::pow(core, 4);
      EXPECT_NEAR(q.value, value, 1e-14 * value) << "z = " << z;
      EXPECT_NEAR(q.slope, slope, 3e-14 * std::abs(slope)) << "z = " << z;
      const KernelFraction<double> fraction = law.fraction(s + law.offset());
      EXPECT_NEAR(fraction.numerator / fraction.denominator, value, 1e-14 * value) << "z = " << z;
    }
  }
}

TEST(LambOseenLaw, IsOneOverTheSquareBeyondItsNearField) {
  const LambOseenLaw law(0.3);
  EXPECT_DOUBLE_EQ(law.near_field(), 40.0 * 0.09);
}

TEST(LambOseenLaw, IsRegularAtTheVortexItself) {
  const LambOseenLaw law(0.1);
  const KernelSlope<double> q = law.slope(law.offset());
  EXPECT_NEAR(q.value, 100.0, 1e-11);
  EXPECT_NEAR(q.slope, -5000.0, 1e-9);
  const KernelFraction<double> fraction = law.fraction(law.offset());
  EXPECT_GT(fraction.denominator, 0.0);
  EXPECT_TRUE(std::isfinite(fraction.numerator / fraction.denominator));
}

TEST(RosenheadMooreLaw, IsItsClosedForm) {
  const RosenheadMooreLaw law(0.5);
  for (const double r2 : {0.0, 1e-12, 0.3, 40.0}) {
    const KernelSlope<double> q = law.slope(r2 + law.offset());
    EXPECT_DOUBLE_EQ(q.value, 1.0 / (r2 + 0.25));
    EXPECT_DOUBLE_EQ(q.slope, -1.0 / ((r2 + 0.25) * (r2 + 0.25)));
    const KernelFraction<double> fraction = law.fraction(r2 + law.offset());
    EXPECT_DOUBLE_EQ(fraction.numerator / fraction.denominator, q.value);
  }
}

}  // namespace
}  // namespace kiln
