#pragma once

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/Model.hpp"
#include "framework/solvers/NewtonSettings.hpp"

namespace kiln {

/// The action V ↦ (∂f/∂u) V of a model's rate Jacobian at a frozen state, in the form a user asked for. Shared by the
/// full-order Newton (matrix-free operators) and by reductions (J Φ).
///
///   diagonal           scales V's leading rows by rate_jacobian_diagonal
///   sparse             as matrix_free: the exact action without a matrix
///   matrix_free        Model::apply_rate_jacobian
///   finite_difference  (f(u + εv) − f(u))/ε for each column v, ε = √ε_machine · max|u| / max|v| over all ranks: the
///                      largest change of a state entry is the relative step that balances truncation and round-off
class JacobianAction {
 public:
  /// The model must outlive this object.
  JacobianAction(const Model& model, JacobianForm form);

  /// Asks the model once for what take() and apply() will; u: sources × components. Throws NotOffered where it lacks
  /// the form. What was taken stays. Collective.
  void require_offered(ConstVectorView u) const;

  /// Freezes ∂f/∂u at u (sources × components) and time in s. Copies what it needs of u. Throws NotOffered where the
  /// model lacks the form. Collective.
  void take(ConstVectorView u, double time);

  /// product ← (∂f/∂u) v. v: sources × components by k; product: rows × components by k. Throws std::logic_error before
  /// the first take(). Collective.
  void apply(ConstMatrixView v, MatrixView product);

  /// Evaluations of the rate spent on finite differences so far.
  long long rate_evaluations() const { return rate_evaluations_; }

 private:
  void difference(ConstMatrixView v, MatrixView product);

  const Model& model_;
  JacobianForm form_;
  bool taken_ = false;
  double time_ = 0.0;
  VectorView u_;         ///< sources × components
  VectorView diagonal_;  ///< rows × components
  VectorView rate_;      ///< f(u), rows × components
  VectorView shifted_;   ///< u + εv
  double largest_u_ = 0.0;
  long long rate_evaluations_ = 0;
};

}  // namespace kiln
