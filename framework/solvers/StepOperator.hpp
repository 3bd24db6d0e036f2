#pragma once

#include "framework/model/Halo.hpp"
#include "framework/solvers/JacobianAction.hpp"

namespace kiln {

/// α0 I − γ ∂f/∂u as an operator over the rows of a distributed model, without a matrix.
class StepOperator : public Operator {
 public:
  /// Both must outlive the operator.
  StepOperator(const Halo& halo, JacobianAction& action) : halo_(halo), action_(action) {}

  void set(double alpha, double gamma) {
    alpha_ = alpha;
    gamma_ = gamma;
  }

  Teuchos::RCP<const Map> getDomainMap() const override { return halo_.rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return halo_.rows(); }
  /// y ← beta y + alpha (α0 I − γ ∂f/∂u) x. Throws NotOffered for a transposed mode.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1.0,
             double beta = 0.0) const override;

 private:
  const Halo& halo_;
  JacobianAction& action_;
  double alpha_ = 1.0;
  double gamma_ = 0.0;
  // Kept from one application to the next: a Krylov solve applies the operator to one column after another.
  mutable Teuchos::RCP<MultiVector> sources_;
  mutable MatrixView product_;
};

}  // namespace kiln
