#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"

/// Dense linear algebra of the reductions on local, column-major views: BLAS and LAPACK calls with the sizes read off
/// the views. A matrix may be a block of a larger one.
namespace kiln::dense {

static_assert(Kokkos::SpaceAccessibility<Kokkos::HostSpace, Device::memory_space>::accessible,
              "BLAS and LAPACK of the reductions read Kokkos views on the host");

enum class Transpose { no, yes };

/// y = alpha A x + beta y.
void multiply(double alpha, const ConstMatrixView& a, const ConstVectorView& x, double beta, const VectorView& y);
/// y = alpha Aᵀ x + beta y.
void multiply_transposed(double alpha, const ConstMatrixView& a, const ConstVectorView& x, double beta,
                         const VectorView& y);
/// y = b + A x and y = Aᵀ x. For matrices so small that what BLAS and views do around a product takes longer than the
/// product, as those of a sample mesh are; larger ones go to BLAS. Arrays are contiguous; y is none of the others.
void affine(const ConstVectorView& b, const ConstMatrixView& a, const double* x, double* y);
void transposed(const ConstMatrixView& a, const double* x, double* y);
/// C = alpha op(A) op(B) + beta C.
void product(Transpose transpose_a, Transpose transpose_b, double alpha, const ConstMatrixView& a,
             const ConstMatrixView& b, double beta, const MatrixView& c);
/// AᵀA, both triangles filled, of this rank's rows.
MatrixView gram(const ConstMatrixView& a);

/// The block of rows first … first + count − 1.
MatrixView row_block(const MatrixView& a, std::size_t first, std::size_t count);
ConstMatrixView row_block(const ConstMatrixView& a, std::size_t first, std::size_t count);
/// The first `count` columns.
MatrixView leading_columns(const MatrixView& a, std::size_t count);
ConstMatrixView leading_columns(const ConstMatrixView& a, std::size_t count);

/// A = U Σ Vᵀ, thin; Σ descending.
struct Svd {
  MatrixView left;
  std::vector<double> values;
  MatrixView right_transposed;
};
Svd svd(const ConstMatrixView& a);

/// Eigenvalues of a symmetric matrix in descending order; its eigenvectors overwrite `a`, column by column. Only the
/// upper triangle is read.
std::vector<double> symmetric_eigen(const MatrixView& a);

/// Householder QR of a local matrix, LAPACK's compact form.
class HouseholderQr {
 public:
  /// Factors `a` in place and keeps it.
  explicit HouseholderQr(MatrixView a);
  /// R, min(rows, columns) × columns, zero below its diagonal.
  MatrixView r() const;
  /// b = Q b for b with as many rows as the factored matrix.
  void apply_q(const MatrixView& b) const;

 private:
  MatrixView factors_;
  std::vector<double> tau_;
};

/// LU factors of a small square matrix; of a very small one its inverse, too, so that a solve is a product.
class LuFactors {
 public:
  /// Factors `a` in place and keeps it. Returns the reciprocal condition number in the 1-norm, 0 for a singular or
  /// non-finite matrix; such factors must not be solved with. Does not allocate where the size stays very small.
  double factor(const MatrixView& a);
  /// b = A⁻¹ b. Does not allocate.
  void solve(const VectorView& b) const;
  /// A⁻ᵀ. Does not allocate.
  void inverse_transposed(const MatrixView& result) const;

 private:
  static constexpr int largest_inverse = 128;

  double reciprocal_condition(double norm);
  /// result = A⁻ᵀ from the factors.
  void invert(const MatrixView& result) const;

  MatrixView factors_;
  std::vector<int> pivots_;
  MatrixView inverse_transposed_;      ///< where the size is at most largest_inverse
  mutable std::vector<double> right_;  ///< right-hand side of a solve by the inverse
};

}  // namespace kiln::dense
