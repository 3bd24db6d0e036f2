#pragma once

#include <functional>
#include <vector>

#include "framework/time/LinearMultistep.hpp"

namespace kiln {

/// What a linear multistep scheme keeps of the time levels of several points (Eq. 14): LinearMultistep's levels, with
/// the points' values next to each other.
class PointHistory {
 public:
  struct Level {
    MatrixView x;  ///< points × coordinates
    MatrixView u;  ///< points by rows × components
    MatrixView f;  ///< likewise; one array for all levels where earlier rates are not needed
    double time = 0.0;
  };

  PointHistory(const LinearMultistep& scheme, double step, std::size_t points, std::size_t coordinates);

  /// Arrays for these many rows × components; those it has, if they are of this size.
  void allocate_rows(std::size_t rows);
  /// Calls `evaluate` for each known level, oldest first.
  void visit(const std::function<void(Level&)>& evaluate);
  /// The coefficients of the next step: those of the starter until enough levels are known.
  const MultistepCoefficients& scheme() const;
  /// Δt β0 in s.
  double gamma() const { return step_ * scheme().beta[0]; }
  /// h of StepResidual for the next step, points by rows × components.
  ConstMatrixView gather();
  std::size_t levels() const { return levels_.size(); }
  /// Where the next step's result belongs; `accept` makes it the newest level.
  Level& next() { return levels_.back(); }
  void accept();
  void forget() { known_ = 0; }

 private:
  const LinearMultistep& scheme_;
  double step_;
  std::size_t points_;
  std::vector<Level> levels_;  ///< newest first, and last the one that the next step writes
  std::size_t known_ = 0;
  MatrixView history_;
};

}  // namespace kiln
