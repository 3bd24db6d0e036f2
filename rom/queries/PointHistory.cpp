#include "rom/queries/PointHistory.hpp"

#include <algorithm>

namespace kiln {
namespace {

void add(double factor, const MatrixView& values, const MatrixView& sum) {
  const double* from = values.data();
  double* to = sum.data();
  Kokkos::parallel_for(
      "kiln::rom::add to history of points", Kokkos::RangePolicy<ExecutionSpace>(0, sum.size()),
      KOKKOS_LAMBDA(const std::size_t i) { to[i] += factor * from[i]; });
}

}  // namespace

PointHistory::PointHistory(const LinearMultistep& scheme, double step, std::size_t points, std::size_t coordinates)
    : scheme_(scheme), step_(step), points_(points), levels_(scheme.coefficients().steps() + 1) {
  for (Level& level : levels_) level.x = MatrixView("kiln::rom::earlier coordinates of points", points, coordinates);
}

void PointHistory::allocate_rows(std::size_t rows) {
  const bool keep_rates = scheme_.coefficients().uses_earlier_rates() || scheme_.starter().uses_earlier_rates();
  for (Level& level : levels_) {
    level.u = MatrixView("kiln::rom::earlier states of points", points_, rows);
    level.f = keep_rates || &level == &levels_[0] ? MatrixView("kiln::rom::earlier rates of points", points_, rows)
                                                  : levels_[0].f;
  }
  history_ = MatrixView("kiln::rom::history of points", points_, rows);
}

void PointHistory::visit(const std::function<void(Level&)>& evaluate) {
  for (std::size_t j = known_; j-- > 0;) evaluate(levels_[j]);
}

const MultistepCoefficients& PointHistory::scheme() const {
  return known_ < scheme_.coefficients().steps() ? scheme_.starter() : scheme_.coefficients();
}

ConstMatrixView PointHistory::gather() {
  Kokkos::deep_copy(history_, 0.0);
  const MultistepCoefficients& coefficients = scheme();
  for (std::size_t j = 1; j <= coefficients.steps(); ++j) {
    const Level& level = levels_[j - 1];
    if (coefficients.alpha[j] != 0.0) add(coefficients.alpha[j], level.u, history_);
    if (coefficients.beta[j] != 0.0) add(-step_ * coefficients.beta[j], level.f, history_);
  }
  return history_;
}

void PointHistory::accept() {
  std::rotate(levels_.begin(), levels_.end() - 1, levels_.end());
  known_ = std::min(known_ + 1, scheme_.coefficients().steps());
}

}  // namespace kiln
