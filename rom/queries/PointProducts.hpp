#pragma once

#include <algorithm>

#include "framework/base/Lanes.hpp"
#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// As many points as go through a product together: a vector, where the host has them (Lanes.hpp), else a double.
#ifdef KILN_LANES
inline constexpr std::size_t points_at_once = lane_count;
inline Lanes at_once(const double* values) { return lanes_at(values); }
inline void store_at_once(double* values, const Lanes& lanes) { store_lanes(values, lanes); }
#else
inline constexpr std::size_t points_at_once = 1;
inline double at_once(const double* values) { return *values; }
inline void store_at_once(double* values, double value) { *values = value; }
#endif

/// y_p = b_p + A x_p of every point p, for one matrix A. x: points × columns of A; b, y: points × rows, with the
/// points' values next to each other. BLAS packs its operands anew in each call, which costs more than so narrow a
/// product.
class PointProduct {
 public:
  explicit PointProduct(ConstMatrixView matrix) : matrix_(matrix) {}

  void add(ConstMatrixView b, ConstMatrixView x, MatrixView y) const {
    std::size_t point = 0;
    for (; point + points_at_once <= y.extent(0); point += points_at_once) {
      std::size_t row = 0;
      for (; row + rows_at_once <= matrix_.extent(0); row += rows_at_once) add<rows_at_once>(point, row, b, x, y);
      for (; row < matrix_.extent(0); ++row) add<1>(point, row, b, x, y);
    }
    for (; point < y.extent(0); ++point) {
      for (std::size_t row = 0; row < matrix_.extent(0); ++row) {
        double sum = b(point, row);
        for (std::size_t k = 0; k < matrix_.extent(1); ++k) sum += matrix_(row, k) * x(point, k);
        y(point, row) = sum;
      }
    }
  }

 private:
  static constexpr std::size_t rows_at_once = 4;

  template <std::size_t Rows>
  void add(std::size_t point, std::size_t row, const ConstMatrixView& b, const ConstMatrixView& x,
           const MatrixView& y) const {
    decltype(at_once(nullptr)) sums[Rows];
    for (std::size_t r = 0; r < Rows; ++r) sums[r] = at_once(&b(point, row + r));
    for (std::size_t k = 0; k < matrix_.extent(1); ++k) {
      const auto factor = at_once(&x(point, k));
      const double* entries = &matrix_(row, k);
      for (std::size_t r = 0; r < Rows; ++r) sums[r] += entries[r] * factor;
    }
    for (std::size_t r = 0; r < Rows; ++r) store_at_once(&y(point, row + r), sums[r]);
  }

  ConstMatrixView matrix_;
};

/// A matrix for each point of a block, the points' entries next to each other.
class PointMatrices {
 public:
  PointMatrices(std::size_t points, std::size_t rows, std::size_t columns)
      : points_(points),
        rows_(rows),
        columns_(columns),
        entries_("kiln::rom::matrices of points", points, rows * columns) {}

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
    for (; point + points_at_once <= points_; point += points_at_once) {
      for (std::size_t k = 0; k < columns_; ++k) {
        // Two sums, since one would wait for itself.
        decltype(at_once(nullptr)) even{}, odd{};
        std::size_t i = 0;
        for (; i + 2 <= rows_; i += 2) {
          even += at_once(&entries_(point, k * rows_ + i)) * at_once(&x(point, i));
          odd += at_once(&entries_(point, k * rows_ + i + 1)) * at_once(&x(point, i + 1));
        }
        if (i < rows_) even += at_once(&entries_(point, k * rows_ + i)) * at_once(&x(point, i));
        store_at_once(&y(point, k), even + odd);
      }
    }
    for (; point < points_; ++point) {
      for (std::size_t k = 0; k < columns_; ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < rows_; ++i) sum += entries_(point, k * rows_ + i) * x(point, i);
        y(point, k) = sum;
      }
    }
  }

 private:
  std::size_t points_, rows_, columns_;
  MatrixView entries_;
};

}  // namespace kiln
