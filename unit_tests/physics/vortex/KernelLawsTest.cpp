#include "physics/vortex/KernelLaws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kiln {
namespace {

/// A number from Lanes through the very code that runs, or from double.
double one_minus_exponential_of(double z, bool lanes) {
#ifdef KILN_LANES
  if (lanes) return one_minus_exponential(all_lanes(z))[3];
#else
  static_cast<void>(lanes);
#endif
  return one_minus_exponential(z);
}

std::vector<double> many_arguments() {
  std::vector<double> arguments{0.0};
  for (double z = 1e-300; z < 1e-6; z *= 37.0) arguments.push_back(z);
  for (double z = 1e-6; z < 60.0; z *= 1.0137) arguments.push_back(z);
  // Where the nearest integer to z/ln 2 changes.
  for (int n = 0; n < 60; ++n) {
    const double edge = (n + 0.5) * 0.6931471805599453;
    for (const double shift : {-1e-15, 0.0, 1e-15}) arguments.push_back(edge * (1.0 + shift));
  }
  for (const double z : {39.999, 40.0, 41.0, 1e3, 1e10, 1e300}) arguments.push_back(z);
  return arguments;
}

TEST(Exponential, IsRightToAFewUnitsInTheLastPlace) {
  for (const bool lanes : {false, true}) {
    for (const double z : many_arguments()) {
      const double expected = static_cast<double>(-std::expm1(-static_cast<long double>(z)));
      EXPECT_NEAR(one_minus_exponential_of(z, lanes), expected, 6e-16 * expected) << "z = " << z;
    }
  }
}

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
  for (const bool lanes : {false, true}) {
    EXPECT_EQ(one_minus_exponential_of(one_minus_exponential_is_one, lanes), 1.0);
    EXPECT_LT(one_minus_exponential_of(35.0, lanes), 1.0);
  }
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
