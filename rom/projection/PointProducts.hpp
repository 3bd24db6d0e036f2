#pragma once

#include "framework/base/Lanes.hpp"
#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/PointRates.hpp"

namespace kiln {

/// One number of a point, of those that several points have next to each other.
struct OnePoint {
  using Numbers = double;
  static Numbers at(const double* numbers) { return *numbers; }
  static void store(double* numbers, Numbers value) { *numbers = value; }
};

#ifdef KILN_LANES
/// The same of eight points at once.
struct EightPoints {
  using Numbers = Lanes;
  static Numbers at(const double* numbers) { return lanes_at(numbers); }
  static void store(double* numbers, const Numbers& lanes) { store_lanes(numbers, lanes); }
};
#endif

/// Calls body(first point, EightPoints()) or body(point, OnePoint()), as the host's vectors and the number of points
/// have it, for the wanted points and perhaps for others.
template <class Body>
void over_points(std::size_t points, const PointMask& wanted, const Body& body) {
  std::size_t point = 0;
#ifdef KILN_LANES
  for (; point + lane_count <= points; point += lane_count) {
    if (any_wanted(wanted, point, lane_count)) body(point, EightPoints());
  }
#endif
  for (; point < points; ++point) {
    if (wanted[point] != 0) body(point, OnePoint());
  }
}

/// y_p = b_p + A x_p of the wanted points p, for one matrix A. x: points × columns of A; b, y: points × rows, with the
/// points' values next to each other. BLAS packs its operands anew in each call, which costs more than so narrow a
/// product.
class PointProduct {
 public:
  explicit PointProduct(ConstMatrixView matrix) : matrix_(matrix) {}

  void add(ConstMatrixView b, ConstMatrixView x, const PointMask& wanted, MatrixView y) const {
    over_points(y.extent(0), wanted, [&](std::size_t point, auto width) {
      using Width = decltype(width);
      std::size_t row = 0;
      for (; row + rows_at_once <= matrix_.extent(0); row += rows_at_once)
        add<Width, rows_at_once>(point, row, b, x, y);
      for (; row < matrix_.extent(0); ++row) add<Width, 1>(point, row, b, x, y);
    });
  }

 private:
  static constexpr std::size_t rows_at_once = 4;

  template <class Width, std::size_t Rows>
  void add(std::size_t point, std::size_t row, const ConstMatrixView& b, const ConstMatrixView& x,
           const MatrixView& y) const {
    typename Width::Numbers sums[Rows];
    for (std::size_t r = 0; r < Rows; ++r) sums[r] = Width::at(&b(point, row + r));
    for (std::size_t k = 0; k < matrix_.extent(1); ++k) {
      const auto factor = Width::at(&x(point, k));
      const double* entries = &matrix_(row, k);
      for (std::size_t r = 0; r < Rows; ++r) sums[r] += entries[r] * factor;
    }
    for (std::size_t r = 0; r < Rows; ++r) Width::store(&y(point, row + r), sums[r]);
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

  void put(std::size_t point, ConstMatrixView matrix) {
    for (std::size_t k = 0; k < columns_; ++k) {
      for (std::size_t i = 0; i < rows_; ++i) entries_(point, k * rows_ + i) = matrix(i, k);
    }
  }

  /// y_p = A_pᵀ x_p of the wanted points p. x: points × rows; y: points × columns.
  void multiply_transposed(ConstMatrixView x, const PointMask& wanted, MatrixView y) const {
    over_points(points_, wanted, [&](std::size_t point, auto width) {
      using Width = decltype(width);
      std::size_t k = 0;
      for (; k + columns_at_once <= columns_; k += columns_at_once) multiply<Width, columns_at_once>(point, k, x, y);
      for (; k < columns_; ++k) multiply<Width, 1>(point, k, x, y);
    });
  }

 private:
  /// Sums that do not wait for each other, and share what they read of x.
  static constexpr std::size_t columns_at_once = 5;

  template <class Width, std::size_t Columns>
  void multiply(std::size_t point, std::size_t column, const ConstMatrixView& x, const MatrixView& y) const {
    typename Width::Numbers sums[Columns] = {};
    for (std::size_t i = 0; i < rows_; ++i) {
      const auto factor = Width::at(&x(point, i));
      for (std::size_t c = 0; c < Columns; ++c)
        sums[c] += Width::at(&entries_(point, (column + c) * rows_ + i)) * factor;
    }
    for (std::size_t c = 0; c < Columns; ++c) Width::store(&y(point, column + c), sums[c]);
  }

  std::size_t points_, rows_, columns_;
  MatrixView entries_;
};

}  // namespace kiln
