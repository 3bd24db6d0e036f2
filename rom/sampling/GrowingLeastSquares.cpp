#include "rom/sampling/GrowingLeastSquares.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kiln {

void GrowingLeastSquares::add_row(std::vector<double> row) {
  for (int k = 0; k < leading_; ++k) {
    std::vector<double>& above = rows_[k];
    const double length = std::hypot(above[k], row[k]);
    if (length == 0.0) continue;
    const double c = above[k] / length, s = row[k] / length;
    for (int j = k; j < columns_; ++j) {
      const double upper = above[j], lower = row[j];
      above[j] = c * upper + s * lower;
      row[j] = c * lower - s * upper;
    }
    row[k] = 0.0;
  }
  rows_.push_back(std::move(row));
}

void GrowingLeastSquares::add_column() {
  const int k = leading_, m = static_cast<int>(rows_.size());
  if (m <= k || k >= columns_) throw std::logic_error("GrowingLeastSquares: more columns than rows");
  ++leading_;
  double below = 0.0;
  for (int i = k + 1; i < m; ++i) below += rows_[i][k] * rows_[i][k];
  if (below == 0.0) return;
  const double diagonal = rows_[k][k];
  const double length = std::sqrt(diagonal * diagonal + below);
  // The reflection v = x ± ‖x‖ e that does not cancel.
  const double head = diagonal + (diagonal < 0.0 ? -length : length);
  const double scale = 2.0 / (head * head + below);
  for (int j = k + 1; j < columns_; ++j) {
    double projection = head * rows_[k][j];
    for (int i = k + 1; i < m; ++i) projection += rows_[i][k] * rows_[i][j];
    projection *= scale;
    rows_[k][j] -= projection * head;
    for (int i = k + 1; i < m; ++i) rows_[i][j] -= projection * rows_[i][k];
  }
  rows_[k][k] = diagonal < 0.0 ? length : -length;
  for (int i = k + 1; i < m; ++i) rows_[i][k] = 0.0;
}

std::vector<double> GrowingLeastSquares::solve(int q) const {
  double largest = 0.0;
  for (int k = 0; k < leading_; ++k) largest = std::max(largest, std::abs(rows_[k][k]));
  std::vector<double> alpha(leading_);
  for (int k = leading_ - 1; k >= 0; --k) {
    double value = rows_[k][q];
    for (int j = k + 1; j < leading_; ++j) value -= rows_[k][j] * alpha[j];
    alpha[k] = std::abs(rows_[k][k]) > 1e-13 * largest ? value / rows_[k][k] : 0.0;
  }
  return alpha;
}

}  // namespace kiln
