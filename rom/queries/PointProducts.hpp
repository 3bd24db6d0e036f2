#pragma once

#include <algorithm>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// y_p = b_p + A x_p of every point p, for one matrix A. x: points × columns of A; b, y: points × rows, with the points'
/// values next to each other. Faster than BLAS, whose packing costs more than the product of a block of a few points: a
/// third of the time at 16 points, 450 rows and 10 columns.
class PointProduct {
 public:
  explicit PointProduct(ConstMatrixView matrix) : matrix_(matrix) {}

  void add(ConstMatrixView b, ConstMatrixView x, MatrixView y) const {
    std::size_t point = 0;
    for (; point + width <= y.extent(0); point += width) add<width>(point, b, x, y);
    for (; point < y.extent(0); ++point) add<1>(point, b, x, y);
  }

 private:
  static constexpr std::size_t width = 8;

  template <std::size_t Width>
  void add(std::size_t point, const ConstMatrixView& b, const ConstMatrixView& x, const MatrixView& y) const {
    const std::size_t rows = matrix_.extent(0), columns = matrix_.extent(1), stride = matrix_.stride(1);
    const std::size_t b_stride = b.stride(1), x_stride = x.stride(1), y_stride = y.stride(1);
    const double* a = matrix_.data();
    const double* from = b.data() + point;
    const double* factors = x.data() + point;
    double* to = y.data() + point;
    for (std::size_t i = 0; i < rows; ++i) {
      double sums[Width];
#pragma omp simd
      for (std::size_t p = 0; p < Width; ++p) sums[p] = from[i * b_stride + p];
      for (std::size_t k = 0; k < columns; ++k) {
        const double entry = a[k * stride + i];
        const double* factor = factors + k * x_stride;
#pragma omp simd
        for (std::size_t p = 0; p < Width; ++p) sums[p] += entry * factor[p];
      }
#pragma omp simd
      for (std::size_t p = 0; p < Width; ++p) to[i * y_stride + p] = sums[p];
    }
  }

  ConstMatrixView matrix_;
};

/// A matrix for each point of a block, the points' entries next to each other.
class PointMatrices {
 public:
  PointMatrices(std::size_t points, std::size_t rows, std::size_t columns)
      : points_(points), rows_(rows), columns_(columns), entries_("kiln::rom::matrices of points", points, rows * columns) {}

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  void put(std::size_t point, ConstMatrixView matrix) {
    for (std::size_t k = 0; k < columns_; ++k) {
      for (std::size_t i = 0; i < rows_; ++i) entries_(point, k * rows_ + i) = matrix(i, k);
    }
  }

  /// y_p = A_pᵀ x_p of every point p. x: points × rows; y: points × columns.
  void multiply_transposed(ConstMatrixView x, MatrixView y) const {
    std::size_t point = 0;
    for (; point + width <= points_; point += width) multiply<width>(point, x, y);
    for (; point < points_; ++point) multiply<1>(point, x, y);
  }

 private:
  static constexpr std::size_t width = 8;

  template <std::size_t Width>
  void multiply(std::size_t point, const ConstMatrixView& x, const MatrixView& y) const {
    for (std::size_t k = 0; k < columns_; ++k) {
      double sums[Width] = {};
      for (std::size_t i = 0; i < rows_; ++i) {
        const double* entry = &entries_(point, k * rows_ + i);
        const double* factor = &x(point, i);
#pragma omp simd
        for (std::size_t p = 0; p < Width; ++p) sums[p] += entry[p] * factor[p];
      }
      std::copy_n(sums, Width, &y(point, k));
    }
  }

  std::size_t points_, rows_, columns_;
  MatrixView entries_;
};

}  // namespace kiln
