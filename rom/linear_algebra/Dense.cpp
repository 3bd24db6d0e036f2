#include "rom/linear_algebra/Dense.hpp"

#include <Teuchos_BLAS.hpp>
#include <Teuchos_CommHelpers.hpp>
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
/// Rows i … i + Blocks · lane_count − 1 of y = b + A x.
template <int Blocks>
void affine_rows(const double* b, const ConstMatrixView& a, const double* x, double* y, std::size_t i) {
  Lanes sums[Blocks];
  for (int block = 0; block < Blocks; ++block) sums[block] = lanes_at(b + i + block * lane_count);
  for (std::size_t k = 0; k < a.extent(1); ++k) {
    const double* const column = &a(i, k);
    const Lanes factor = all_lanes(x[k]);
    for (int block = 0; block < Blocks; ++block) sums[block] += lanes_at(column + block * lane_count) * factor;
  }
  for (int block = 0; block < Blocks; ++block) store_lanes(y + i + block * lane_count, sums[block]);
}

/// The products of as many columns with x.
template <int Columns>
void column_products(const double* column, std::size_t stride, std::size_t rows, const double* x, double* y) {
  Lanes sums[Columns] = {};
  std::size_t i = 0;
  for (; i + lane_count <= rows; i += lane_count) {
    const Lanes factor = lanes_at(x + i);
    for (int c = 0; c < Columns; ++c) sums[c] += lanes_at(column + c * stride + i) * factor;
  }
  for (int c = 0; c < Columns; ++c) y[c] = lane_sum(sums[c]);
  for (; i < rows; ++i) {
    for (int c = 0; c < Columns; ++c) y[c] += column[c * stride + i] * x[i];
  }
}
#endif

}  // namespace

void affine(const ConstVectorView& b, const ConstMatrixView& a, const double* x, double* y) {
  const std::size_t rows = a.extent(0), columns = a.extent(1);
  if (rows * columns > short_product) {
    std::copy_n(b.data(), rows, y);
    Blas().GEMV(Teuchos::NO_TRANS, static_cast<int>(rows), static_cast<int>(columns), 1.0, a.data(),
                leading_dimension(a), x, 1, 1.0, y, 1);
    return;
  }
  std::size_t i = 0;
#ifdef KILN_LANES
  for (; i + 4 * lane_count <= rows; i += 4 * lane_count) affine_rows<4>(b.data(), a, x, y, i);
  for (; i + lane_count <= rows; i += lane_count) affine_rows<1>(b.data(), a, x, y, i);
#endif
  for (; i < rows; ++i) {
    double sum = b(i);
    for (std::size_t k = 0; k < columns; ++k) sum += a(i, k) * x[k];
    y[i] = sum;
  }
}

void transposed(const ConstMatrixView& a, const double* x, double* y) {
  const std::size_t rows = a.extent(0), columns = a.extent(1);
  if (rows * columns > short_product) {
    Blas().GEMV(Teuchos::TRANS, static_cast<int>(rows), static_cast<int>(columns), 1.0, a.data(), leading_dimension(a),
                x, 1, 0.0, y, 1);
    return;
  }
  std::size_t k = 0;
#ifdef KILN_LANES
  const std::size_t stride = leading_dimension(a);
  for (; k + 5 <= columns; k += 5) column_products<5>(a.data() + k * stride, stride, rows, x, y + k);
  for (; k < columns; ++k) column_products<1>(a.data() + k * stride, stride, rows, x, y + k);
#endif
  for (; k < columns; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rows; ++i) sum += a(i, k) * x[i];
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
    for (int j = 0; j < columns(c); ++j) {
      const VectorView column = Kokkos::subview(c, Kokkos::ALL, j);
      if (transpose_a == Transpose::yes) {
        transposed(a, &b(0, j), column.data());
      } else {
        scale(0.0, column);
        affine(column, a, &b(0, j), column.data());
      }
    }
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

void sum_over_ranks(const Communicator& communicator, double* values, std::size_t count) {
  if (communicator.getSize() == 1) return;
  // Blocks keep the second buffer, and MPI's count, small.
  constexpr std::size_t block = std::size_t(1) << 22;
  std::vector<double> sum(std::min(block, count));
  for (std::size_t first = 0; first < count; first += block) {
    const int length = static_cast<int>(std::min(block, count - first));
    Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, length, values + first, sum.data());
    std::copy_n(sum.data(), length, values + first);
  }
}

void broadcast(const Communicator& communicator, double* values, std::size_t count) {
  if (communicator.getSize() == 1) return;
  constexpr std::size_t block = std::size_t(1) << 26;
  for (std::size_t first = 0; first < count; first += block) {
    Teuchos::broadcast(communicator, 0, static_cast<int>(std::min(block, count - first)), values + first);
  }
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
