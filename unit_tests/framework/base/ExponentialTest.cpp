#include "framework/base/Exponential.hpp"

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

TEST(Exponential, OneMinusItIsOneFromForty) {
  for (const bool lanes : {false, true}) {
    EXPECT_EQ(one_minus_exponential_of(one_minus_exponential_is_one, lanes), 1.0);
    EXPECT_LT(one_minus_exponential_of(35.0, lanes), 1.0);
  }
}

#ifdef KILN_LANES
TEST(Exponential, DecayIsRightToAFewUnitsInTheLastPlaceUntilItVanishes) {
  std::vector<double> arguments = many_arguments();
  for (double z = 60.0; z < 708.0; z += 0.77) arguments.push_back(z);
  for (const double z : arguments) {
    const double found = decayed(all_lanes(z))[5];
    if (z < 708.0) {
      const double expected = static_cast<double>(std::exp(-static_cast<long double>(z)));
      EXPECT_NEAR(found, expected, 6e-16 * expected) << "z = " << z;
    } else {
      EXPECT_EQ(found, 0.0) << "z = " << z;
    }
  }
  EXPECT_EQ(decayed(all_lanes(0.0))[0], 1.0);
}
#endif

}  // namespace
}  // namespace kiln
