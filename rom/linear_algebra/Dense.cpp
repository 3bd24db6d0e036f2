#include "rom/linear_algebra/Dense.hpp"

#include <Teuchos_BLAS.hpp>
#include <algorithm>

#include "framework/base/Lanes.hpp"

namespace kiln::dense {
namespace {

using Blas = Teuchos::BLAS<int, double>;

int rows(const ConstMatrixView& a) { return static_cast<int>(a.extent(0)); }
int columns(const ConstMatrixView& a) { return static_cast<int>(a.extent(1)); }
int leading_dimension(const ConstMatrixView& a) { return std::max<int>(1, std::max<int>(rows(a), a.stride(1))); }

void scale(double beta, const VectorView& y) {
  for (std::size_t i = 0; i < y.extent(0); ++i) y(i) = beta == 0.0 ? 0.0 : beta * y(i);
}

void multiply(Teuchos::ETransp transpose, double alpha, const ConstMatrixView& a, const ConstVectorView& x, double beta,
              const VectorView& y) {
  // BLAS returns at once for an empty matrix and leaves y as it was.
  if (rows(a) == 0 || columns(a) == 0) return scale(beta, y);
  Blas().GEMV(transpose, rows(a), columns(a), alpha, a.data(), leading_dimension(a), x.data(), 1, beta, y.data(), 1);
}

/// Entries of a matrix up to which affine() and transposed() go without BLAS: what a core keeps at hand.
constexpr std::size_t short_product = 1 << 15;
/// Columns of a product up to which it goes column by column: BLAS packs its operands anew in each call.
constexpr int narrow = 16;

#ifdef KILN_LANES
/// Columns next to each other, the first of them and how far apart they begin.
template <class Number>
struct Strided {
  Number* first;
  std::size_t stride;
};

/// Rows i … i + Blocks · lane_count − 1 of y_c = b + A x_c for as many columns c; the last block ends at row `end` and
/// may begin in the one before it. Without b: y_c = A x_c.
template <int Blocks, int Columns>
void affine_rows(const double* b, const ConstMatrixView& a, Strided<const double> x, Strided<double> y, std::size_t i,
                 std::size_t end) {
  std::size_t first[Blocks];
  for (int block = 0; block < Blocks; ++block) first[block] = i + block * lane_count;
  first[Blocks - 1] = std::min(first[Blocks - 1], end - lane_count);
  Lanes sums[Columns][Blocks] = {};
  if (b != nullptr) {
    for (int c = 0; c < Columns; ++c) {
      for (int block = 0; block < Blocks; ++block) sums[c][block] = lanes_at(b + first[block]);
    }
  }
  for (std::size_t k = 0; k < a.extent(1); ++k) {
    const double* const column = &a(0, k);
    for (int c = 0; c < Columns; ++c) {
      const Lanes factor = all_lanes(x.first[c * x.stride + k]);
      for (int block = 0; block < Blocks; ++block) sums[c][block] += lanes_at(column + first[block]) * factor;
    }
  }
  for (int c = 0; c < Columns; ++c) {
    for (int block = 0; block < Blocks; ++block) store_lanes(y.first + c * y.stride + first[block], sums[c][block]);
  }
}

/// The same of all rows, at least lane_count.
template <int Columns>
void affine_by_lanes(const double* b, const ConstMatrixView& a, Strided<const double> x, Strided<double> y) {
  const std::size_t rows = a.extent(0);
  std::size_t i = 0;
  for (; i + 4 * lane_count <= rows; i += 4 * lane_count) affine_rows<4, Columns>(b, a, x, y, i, rows);
  switch ((rows - i + lane_count - 1) / lane_count) {
    case 1:
      return affine_rows<1, Columns>(b, a, x, y, i, rows);
    case 2:
      return affine_rows<2, Columns>(b, a, x, y, i, rows);
    case 3:
      return affine_rows<3, Columns>(b, a, x, y, i, rows);
    case 4:
      return affine_rows<4, Columns>(b, a, x, y, i, rows);
  }
}

/// The products of as many columns with x; `tail`: the last lane_count entries of x, zero where those before it have
/// them.
template <int Columns>
void column_products(const double* column, std::size_t stride, std::size_t rows, const double* x, const Lanes& tail,
                     double* y) {
  Lanes sums[Columns] = {};
  std::size_t i = 0;
  for (; i + lane_count <= rows; i += lane_count) {
    const Lanes factor = lanes_at(x + i);
    for (int c = 0; c < Columns; ++c) sums[c] += lanes_at(column + c * stride + i) * factor;
  }
  if (i < rows) {
    for (int c = 0; c < Columns; ++c) sums[c] += lanes_at(column + c * stride + rows - lane_count) * tail;
  }
  for (int c = 0; c < Columns; ++c) y[c] = lane_sum(sums[c]);
}

/// y = Aᵀ x with a matrix of at least lane_count rows.
void transposed_by_lanes(const ConstMatrixView& a, const double* x, double* y) {
  const std::size_t rows = a.extent(0), columns = a.extent(1), stride = leading_dimension(a);
  Lanes tail = lanes_at(x + rows - lane_count);
  for (std::size_t lane = 0; lane < lane_count - rows % lane_count; ++lane) tail[lane] = 0.0;
  std::size_t k = 0;
  for (; k + 5 <= columns; k += 5) column_products<5>(a.data() + k * stride, stride, rows, x, tail, y + k);
  for (; k < columns; ++k) column_products<1>(a.data() + k * stride, stride, rows, x, tail, y + k);
}
#endif

/// y = b + A x without BLAS; without b: y = A x.
void short_affine(const double* b, const ConstMatrixView& a, const double* x, double* y) {
#ifdef KILN_LANES
  if (a.extent(0) >= lane_count) return affine_by_lanes<1>(b, a, {x, 0}, {y, 0});
#endif
  for (std::size_t i = 0; i < a.extent(0); ++i) {
    double sum = b == nullptr ? 0.0 : b[i];
    for (std::size_t k = 0; k < a.extent(1); ++k) sum += a(i, k) * x[k];
    y[i] = sum;
  }
}

/// C = A B without BLAS.
void short_product_of(const ConstMatrixView& a, const ConstMatrixView& b, const MatrixView& c) {
  std::size_t j = 0;
#ifdef KILN_LANES
  // Sums that do not wait for each other, and share what they read of A.
  constexpr std::size_t at_once = 4;
  for (; a.extent(0) >= lane_count && j + at_once <= c.extent(1); j += at_once) {
    affine_by_lanes<at_once>(nullptr, a, {&b(0, j), b.stride(1)}, {&c(0, j), c.stride(1)});
  }
#endif
  for (; j < c.extent(1); ++j) short_affine(nullptr, a, &b(0, j), &c(0, j));
}

}  // namespace

void affine(const ConstVectorView& b, const ConstMatrixView& a, const double* x, double* y) {
  if (a.size() <= short_product) return short_affine(b.data(), a, x, y);
  std::copy_n(b.data(), a.extent(0), y);
  Blas().GEMV(Teuchos::NO_TRANS, rows(a), columns(a), 1.0, a.data(), leading_dimension(a), x, 1, 1.0, y, 1);
}

void transposed(const ConstMatrixView& a, const double* x, double* y) {
  if (a.size() > short_product) {
    Blas().GEMV(Teuchos::TRANS, rows(a), columns(a), 1.0, a.data(), leading_dimension(a), x, 1, 0.0, y, 1);
    return;
  }
#ifdef KILN_LANES
  if (a.extent(0) >= lane_count) return transposed_by_lanes(a, x, y);
#endif
  for (std::size_t k = 0; k < a.extent(1); ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.extent(0); ++i) sum += a(i, k) * x[i];
    y[k] = sum;
  }
}

void multiply(double alpha, const ConstMatrixView& a, const ConstVectorView& x, double beta, const VectorView& y) {
  multiply(Teuchos::NO_TRANS, alpha, a, x, beta, y);
}

void multiply_transposed(double alpha, const ConstMatrixView& a, const ConstVectorView& x, double beta,
                         const VectorView& y) {
  multiply(Teuchos::TRANS, alpha, a, x, beta, y);
}

void product(Transpose transpose_a, Transpose transpose_b, double alpha, const ConstMatrixView& a,
             const ConstMatrixView& b, double beta, const MatrixView& c) {
  const int inner = transpose_a == Transpose::yes ? rows(a) : columns(a);
  if (rows(c) == 0 || columns(c) == 0) return;
  if (inner == 0) {
    for (int j = 0; j < columns(c); ++j) scale(beta, Kokkos::subview(c, Kokkos::ALL, j));
    return;
  }
  if (transpose_b == Transpose::no && alpha == 1.0 && beta == 0.0 && a.size() <= short_product &&
      columns(c) <= narrow) {
    if (transpose_a == Transpose::no) return short_product_of(a, b, c);
    for (int j = 0; j < columns(c); ++j) transposed(a, &b(0, j), &c(0, j));
    return;
  }
  Blas().GEMM(transpose_a == Transpose::yes ? Teuchos::TRANS : Teuchos::NO_TRANS,
              transpose_b == Transpose::yes ? Teuchos::TRANS : Teuchos::NO_TRANS, rows(c), columns(c), inner, alpha,
              a.data(), leading_dimension(a), b.data(), leading_dimension(b), beta, c.data(), leading_dimension(c));
}

MatrixView gram(const ConstMatrixView& a) {
  const int size = columns(a);
  MatrixView result("kiln::rom::gram", size, size);
  if (rows(a) == 0 || size == 0) return result;
  Blas().SYRK(Teuchos::UPPER_TRI, Teuchos::TRANS, size, rows(a), 1.0, a.data(), leading_dimension(a), 0.0,
              result.data(), size);
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < j; ++i) result(j, i) = result(i, j);
  }
  return result;
}

MatrixView row_block(const MatrixView& a, std::size_t first, std::size_t count) {
  return Kokkos::subview(a, std::make_pair(first, first + count), Kokkos::ALL);
}

ConstMatrixView row_block(const ConstMatrixView& a, std::size_t first, std::size_t count) {
  return Kokkos::subview(a, std::make_pair(first, first + count), Kokkos::ALL);
}

MatrixView leading_columns(const MatrixView& a, std::size_t count) {
  return Kokkos::subview(a, Kokkos::ALL, std::make_pair(std::size_t(0), count));
}

ConstMatrixView leading_columns(const ConstMatrixView& a, std::size_t count) {
  return Kokkos::subview(a, Kokkos::ALL, std::make_pair(std::size_t(0), count));
}

}  // namespace kiln::dense
