#include "framework/time/MultistepCoefficients.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kiln {
namespace {

/// All problems' texts, one a line.
std::string problems(std::vector<double> alpha, std::vector<double> beta) {
  std::string text;
  for (const Problem& problem : MultistepCoefficients{std::move(alpha), std::move(beta)}.problems()) {
    text += problem.path + ": " + problem.found + "; expected " + problem.expected + "\n";
  }
  return text;
}

void expect_in(const std::string& text, const std::string& words) {
  EXPECT_NE(text.find(words), std::string::npos) << words << " not in: " << text;
}

TEST(MultistepCoefficients, OrdersAreKnown) {
  EXPECT_EQ(MultistepCoefficients::backward_euler().order(), 1);
  EXPECT_EQ(MultistepCoefficients::explicit_euler().order(), 1);
  EXPECT_EQ(MultistepCoefficients::trapezoidal().order(), 2);
  EXPECT_EQ(MultistepCoefficients::bdf2().order(), 2);
  EXPECT_EQ((MultistepCoefficients{{11, -18, 9, -2}, {6, 0, 0, 0}}.order()), 3);
  EXPECT_EQ((MultistepCoefficients{{1, -1, 0, 0}, {9.0 / 24, 19.0 / 24, -5.0 / 24, 1.0 / 24}}.order()), 4);
  // Milne and Simpson's scheme has the highest order two steps allow.
  EXPECT_EQ((MultistepCoefficients{{1, 0, -1}, {1.0 / 3, 4.0 / 3, 1.0 / 3}}.order()), 4);
}

TEST(MultistepCoefficients, OnlyEarlierRatesThatCountAreKept) {
  EXPECT_FALSE(MultistepCoefficients::backward_euler().uses_earlier_rates());
  EXPECT_FALSE(MultistepCoefficients::bdf2().uses_earlier_rates());
  EXPECT_TRUE(MultistepCoefficients::trapezoidal().uses_earlier_rates());
}

TEST(MultistepCoefficients, GoodOnesPass) {
  EXPECT_EQ(problems({1, -1}, {1, 0}), "");
  EXPECT_EQ(problems({1.5, -2, 0.5}, {1, 0, 0}), "");
  EXPECT_EQ(problems({1, 0, -1}, {0, 2, 0}), "") << "leapfrog: a simple root at −1";
  EXPECT_EQ(problems({11.0 / 6, -3, 1.5, -1.0 / 3}, {1, 0, 0, 0}), "");
}

TEST(MultistepCoefficients, BadOnesAreNamed) {
  expect_in(problems({1}, {1}), "alpha: there are 1 coefficients; expected at least alpha_0 and alpha_1");
  expect_in(problems({1, -1}, {1}), "beta: there are 1 coefficients; expected as many as alpha has: 2");
  expect_in(problems({0, 1, -1}, {1, 0, 0}), "alpha: alpha_0 is 0");
  expect_in(problems({1, -0.9}, {1, 0}), "alpha: the coefficients add up to 0.1: the scheme is not consistent");
  expect_in(problems({1, -1}, {1, 1}),
            "beta: the coefficients add up to 2: the scheme is not consistent; expected -sum of j alpha_j = 1");
  expect_in(problems({1, std::nan("")}, {1, 0}), "alpha: nan is not finite");
}

TEST(MultistepCoefficients, UnstableOnesAreNamed) {
  // The most accurate explicit scheme of two steps, of order 3, with the root −5.
  expect_in(problems({1, 4, -5}, {0, 4, 2}), "a root of size 5: the scheme is not zero-stable");
  // A double root at 1.
  expect_in(problems({1, -2, 1}, {0, 0, 0}), "a multiple root of size 1");
  // BDF7 is the first of its family that is not stable.
  expect_in(problems({363.0 / 140, -7, 10.5, -35.0 / 3, 8.75, -4.2, 7.0 / 6, -1.0 / 7}, {1, 0, 0, 0, 0, 0, 0, 0}),
            "not zero-stable");
  EXPECT_EQ(problems({147.0 / 60, -6, 7.5, -20.0 / 3, 3.75, -1.2, 1.0 / 6}, {1, 0, 0, 0, 0, 0, 0}), "") << "BDF6";
}

}  // namespace
}  // namespace kiln
