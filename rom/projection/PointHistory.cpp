#include "rom/projection/PointHistory.hpp"

#include <algorithm>

#include "framework/base/Loop.hpp"

namespace kiln {
namespace {

// Labels made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string add_label = "kiln::rom::add to history of points";

/// `first`: the sum is overwritten.
void add(double factor, const MatrixView& values, bool first, const MatrixView& sum) {
  const double* from = values.data();
  double* to = sum.data();
  loop(
      add_label, static_cast<LocalIndex>(sum.size()),
      KOKKOS_LAMBDA(const LocalIndex i) { to[i] = (first ? 0.0 : to[i]) + factor * from[i]; });
}

}  // namespace

PointHistory::PointHistory(const LinearMultistep& scheme, double step, std::size_t points, std::size_t coordinates)
    : scheme_(scheme), step_(step), points_(points), levels_(scheme.coefficients().steps() + 1) {
  for (Level& level : levels_) level.x = MatrixView("kiln::rom::earlier coordinates of points", points, coordinates);
}

void PointHistory::allocate_rows(std::size_t rows) {
  if (history_.extent(1) == rows) return;
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
  const MultistepCoefficients& coefficients = scheme();
  for (std::size_t j = 1; j <= coefficients.steps(); ++j) {
    const Level& level = levels_[j - 1];
    if (j == 1 || coefficients.alpha[j] != 0.0) add(coefficients.alpha[j], level.u, j == 1, history_);
    if (coefficients.beta[j] != 0.0) add(-step_ * coefficients.beta[j], level.f, false, history_);
  }
  return history_;
}

void PointHistory::accept() {
  std::rotate(levels_.begin(), levels_.end() - 1, levels_.end());
  known_ = std::min(known_ + 1, scheme_.coefficients().steps());
}

}  // namespace kiln
