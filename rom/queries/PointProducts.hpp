#pragma once

#include <algorithm>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

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
