#include "rom/linear_algebra/Dense.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit_tests/rom/clustering/Random.hpp"

namespace kiln::dense {
namespace {

MatrixView random_matrix(std::size_t rows, std::size_t columns, unsigned seed) {
  test::Random random(seed);
  MatrixView a("a", rows, columns);
  for (std::size_t k = 0; k < columns; ++k) {
    for (std::size_t i = 0; i < rows; ++i) a(i, k) = random.between(-1.0, 1.0);
  }
  return a;
}

VectorView column_of(const MatrixView& a, std::size_t k) { return Kokkos::subview(a, Kokkos::ALL, k); }

/// With every remainder of the vectors' width, in a block of a larger matrix, and beyond what goes without BLAS.
TEST(Dense, ShortProductsArePlainSums) {
  for (const std::size_t rows : {0, 1, 7, 8, 9, 14, 24, 28, 31, 32, 41, 100, 5000}) {
    for (const std::size_t columns : {0, 1, 10, 12}) {
      const MatrixView whole = random_matrix(rows + 3, columns + 2, 3);
      const ConstMatrixView a =
          Kokkos::subview(whole, std::make_pair(std::size_t(2), rows + 2), std::make_pair(std::size_t(1), columns + 1));
      const VectorView b = column_of(random_matrix(rows, 1, 5), 0), x = column_of(random_matrix(columns, 1, 7), 0);
      const VectorView y("y", rows), z("z", columns);
      affine(b, a, x.data(), y.data());
      transposed(a, b.data(), z.data());
      for (std::size_t k = 0; k < columns; ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < rows; ++i) sum += a(i, k) * b(i);
        EXPECT_NEAR(z(k), sum, 1e-12) << rows << " rows, " << columns << " columns";
      }
      for (std::size_t i = 0; i < rows; ++i) {
        double sum = b(i);
        for (std::size_t k = 0; k < columns; ++k) sum += a(i, k) * x(k);
        EXPECT_NEAR(y(i), sum, 1e-14) << rows << " rows, " << columns << " columns";
      }
    }
  }
}

/// With as few columns as go one by one, with more of them, and beyond what goes without BLAS.
TEST(Dense, ProductsArePlainSums) {
  for (const std::size_t inner : {0, 1, 14, 3000}) {
    for (const std::size_t columns : {1, 10, 16, 17}) {
      const MatrixView a = random_matrix(12, inner, 3), b = random_matrix(inner, columns, 5),
                       c = random_matrix(12, columns, 7), d = random_matrix(12, columns, 9);
      const MatrixView turned("turned", inner, 12);
      for (std::size_t k = 0; k < inner; ++k) {
        for (std::size_t i = 0; i < 12; ++i) turned(k, i) = a(i, k);
      }
      product(Transpose::no, Transpose::no, 1.0, a, b, 0.0, c);
      product(Transpose::yes, Transpose::no, 1.0, turned, b, 0.0, d);
      for (std::size_t j = 0; j < columns; ++j) {
        for (std::size_t i = 0; i < 12; ++i) {
          double sum = 0.0;
          for (std::size_t k = 0; k < inner; ++k) sum += a(i, k) * b(k, j);
          EXPECT_NEAR(c(i, j), sum, 1e-12) << inner << " terms, " << columns << " columns";
          EXPECT_NEAR(d(i, j), sum, 1e-12) << inner << " terms, " << columns << " columns, transposed";
        }
      }
    }
  }
}

/// Sizes with an inverse, and one without.
TEST(LuFactors, SolvesAndTellsItsCondition) {
  for (const std::size_t n : {1, 5, 64, 65, 90}) {
    const MatrixView a = random_matrix(n, n, 11);
    for (std::size_t k = 0; k < n; ++k) a(k, k) += 3.0 * std::sqrt(static_cast<double>(n));
    const MatrixView kept("kept", n, n);
    Kokkos::deep_copy(kept, a);
    LuFactors factors;
    const double condition = factors.factor(a);
    EXPECT_GT(condition, 1e-3);
    EXPECT_LE(condition, 1.0 + 1e-12);
    const VectorView x = column_of(random_matrix(n, 1, 13), 0), b("b", n);
    multiply(1.0, kept, x, 0.0, b);
    factors.solve(b);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(b(i), x(i), 1e-12) << n;
    Kokkos::deep_copy(a, 0.0);
    for (std::size_t k = 0; k < n; ++k) a(k, k) = k == 0 ? 1e-6 : 2.0;
    EXPECT_NEAR(factors.factor(a), n == 1 ? 1.0 : 5e-7, 1e-12);
  }
}

TEST(LuFactors, TellsSingularMatrices) {
  for (const std::size_t n : {3, 70}) {
    LuFactors factors;
    const MatrixView zero("zero", n, n), twice = random_matrix(n, n, 17), nan = random_matrix(n, n, 19);
    EXPECT_EQ(factors.factor(zero), 0.0);
    for (std::size_t i = 0; i < n; ++i) twice(i, 1) = twice(i, 0);
    EXPECT_LT(factors.factor(twice), 1e-15);
    nan(1, 1) = std::nan("");
    EXPECT_EQ(factors.factor(nan), 0.0);
  }
}

}  // namespace
}  // namespace kiln::dense
