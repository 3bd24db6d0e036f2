#pragma once

#include <memory>

#include "framework/model/Halo.hpp"
#include "framework/model/Model.hpp"
#include "framework/solvers/LinearSolver.hpp"
#include "framework/solvers/NewtonSettings.hpp"

namespace kiln {

/// The Jacobian α0 I − γ ∂f/∂u of a step's residual (Eq. 14), with ∂f/∂u frozen where it was last taken. α0 and γ may
/// change from solve to solve: a multistep scheme's first steps use other ones.
class StepJacobian {
 public:
  virtual ~StepJacobian() = default;

  /// Throws NotOffered where the model lacks what take() and solve() need of it; u: sources × components. What was
  /// taken is lost. Collective.
  virtual void require_offered(ConstVectorView u) = 0;
  /// Freezes ∂f/∂u at u (sources × components) and time in s. Throws NotOffered where the model lacks the form.
  virtual void take(ConstVectorView u, double time) = 0;
  /// dx = (α0 I − γ ∂f/∂u)⁻¹ r over the rows. Collective.
  virtual LinearSolveReport solve(double alpha, double gamma, ConstVectorView r, VectorView dx) = 0;
  /// Evaluations of the rate that the Jacobian itself has cost so far.
  virtual long long rate_evaluations() const { return 0; }

  /// The form's implementation:
  ///   diagonal                        the inverse of the diagonal, without a linear solver
  ///   sparse                          one reused CrsMatrix α0 I − γ J, given to `solver`
  ///   matrix_free, finite_difference  an Operator over JacobianAction, given to `solver`
  /// `solver` may be null for `diagonal`. The model and the halo must outlive the result. A Jacobi preconditioner takes
  /// the diagonal from the matrix or from Model::rate_jacobian_diagonal.
  static std::unique_ptr<StepJacobian> create(JacobianForm form, const Model& model, const Halo& halo,
                                              std::shared_ptr<LinearSolver> solver);
};

}  // namespace kiln
