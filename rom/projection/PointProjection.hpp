#pragma once

#include <memory>
#include <optional>

#include "framework/base/Error.hpp"
#include "framework/model/PointRates.hpp"
#include "framework/queries/PointBlock.hpp"
#include "rom/projection/PointProducts.hpp"
#include "rom/projection/PointStates.hpp"
#include "rom/projection/Projection.hpp"

namespace kiln {

/// The equations of a Projection for several parameter points at once. Each point has a frozen Jacobian, a test basis
/// and factors of its own and counts its own iterations; states, rates and residuals of all points are found in one
/// go. A point that has converged keeps its coordinates; while others of its eight iterate, its lane finds the same
/// state and rate again.
class PointProjection {
 public:
  struct Point {
    SolveReport solve = {};                          ///< of the last step
    std::optional<DivergenceError> divergence = {};  ///< set: the point is left behind
  };

  /// `projection` lends model, trial space and test basis; none of its own state is touched.
  PointProjection(Projection& projection, const ParameterPoints& points);

  /// Goes over to other points, of the same number.
  void take(const ParameterPoints& points);

  std::size_t row_size() const { return rows_; }
  /// Takes the states in which the window begins.
  void begin(ConstMatrixView x) { states_.begin(x); }
  /// As the functions of Projection, with an array's values of the points next to each other.
  void evaluate(ConstMatrixView x, double time, MatrixView u, MatrixView f);
  /// `residual.history` is empty; `history`: points by rows × components.
  void solve(const StepResidual& residual, ConstMatrixView history, MatrixView x, MatrixView u, MatrixView f,
             std::vector<Point>& points);

 private:
  void linearise(const StepResidual& residual, MatrixView x, std::vector<Point>& points);
  void linearise_point(std::size_t point, const StepResidual& residual);
  void iterate(const StepResidual& residual, ConstMatrixView history, MatrixView x, MatrixView f,
               std::vector<Point>& points);
  /// Fills g_ = Ψᵀr and norms_ of the points that iterate, from state_ and the rate times γ.
  void reduce_residual(const StepResidual& residual, double gamma, ConstMatrixView history, ConstMatrixView f);
  /// The Euclidean norm of each iterating point's row of an array, points × entries.
  void take_norms(ConstMatrixView arrays, std::vector<double>& norms) const;
  /// Fills goals_ from norms_, those of the step's first residual.
  void set_goals(ConstMatrixView history);
  /// x ← x − (ΨᵀJ̃Φ)⁻¹ g_ of the points that iterate.
  void update(MatrixView x);
  /// Leaves points behind whose residual is not finite or has grown past what counts as divergence.
  void watch(const StepResidual& residual, MatrixView x, ConstMatrixView f, std::vector<Point>& points);
  void leave_behind(std::size_t point, const char* what, double time, MatrixView x, ConstMatrixView f, Point& outcome);

  Projection& projection_;
  Model& model_;
  const TrialSpace& trial_;
  NewtonSettings settings_;
  ParameterPoints points_;
  std::unique_ptr<PointRates> rates_;
  PointStates states_;
  std::size_t rows_, size_;
  JacobianAction jacobian_;

  double frozen_alpha_ = 0.0, frozen_gamma_ = 0.0;
  int age_ = -1;                      ///< steps the Jacobians have served; −1: not taken yet
  PointMatrices test_;                ///< Ψ of each point
  PointMatrices inverse_transposed_;  ///< (ΨᵀJ̃Φ)⁻ᵀ of each point

  // Handed on in each iteration, without an owner to count.
  MatrixView state_;                ///< points by sources × components
  MatrixView residual_;             ///< points by rows × components
  MatrixView g_, step_;             ///< points × M
  std::vector<double> norms_;       ///< ‖Ψᵀr‖₂ of each point
  std::vector<double> test_norms_;  ///< ‖Ψ‖_F of each point
  std::vector<double> goals_;       ///< Projection::goal of each point
  PointMask everyone_;
  PointMask iterates_;         ///< those that have not converged yet
  std::vector<double> moves_;  ///< the same as numbers, for vectors

  std::vector<MatrixView> owners_;  ///< of the arrays above

  // Of one point.
  VectorView point_state_;
  MatrixView jacobian_tangent_, small_, inverse_;
  dense::LuFactors factors_;
};

}  // namespace kiln
