#pragma once

#include <memory>
#include <vector>

#include "framework/queries/PointBlock.hpp"
#include "rom/projection/PetrovGalerkin.hpp"
#include "rom/projection/PointHistory.hpp"
#include "rom/projection/PointProjection.hpp"

namespace kiln {

/// Points of a Petrov–Galerkin method that advance together through its time windows by a linear multistep scheme.
///
/// TimeScheme and run_time_loop advance one unknown, and what they hand to Method::solve is the history of one; here
/// all points' unknowns, histories and residuals stand next to each other, so that a basis, a neighbour or a weight is
/// read once for all of them and the reconstruction of states is a product of matrices.
class ReducedBlock final : public PointBlock {
 public:
  ReducedBlock(PetrovGalerkin& method, const LinearMultistep& scheme, AdvancesTogether::Request request);

  void start(const ParameterPoints& points) override;
  void advance(int step, double time) override;
  void tell(MatrixView u) const override { windows_[window_]->told->states(x_, everyone_, u); }
  const std::vector<PointOutcome>& outcomes() const override { return outcomes_; }

 private:
  struct Window {
    std::unique_ptr<PointProjection> projection;
    std::unique_ptr<TrialSpace> told_space;  ///< at the places
    std::unique_ptr<PointStates> told;
  };
  /// Made when a block of points first enters it.
  Window& window(std::size_t number);
  /// Goes over to another window: its equations, and the history at its rows.
  void enter(std::size_t number);
  /// Copies x_ into a level of the history.
  void keep_coordinates(const MatrixView& kept);

  PetrovGalerkin& method_;
  std::size_t count_;  ///< of points
  ParameterPoints points_;
  PointMask everyone_;
  std::vector<LocalIndex> places_;
  PointHistory history_;
  MatrixView x_;  ///< points × coordinates
  std::vector<std::unique_ptr<Window>> windows_;
  std::size_t window_ = 0;
  bool started_ = false;
  std::size_t whole_levels_ = 0;  ///< levels written since the window began
  std::vector<PointProjection::Point> states_;
  std::vector<PointOutcome> outcomes_;
};

}  // namespace kiln
