#pragma once

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// D⁻¹ as an operator: the Jacobi preconditioner.
class DiagonalInverse : public Operator {
 public:
  /// A zero entry becomes infinity, which the solver that uses this reports as a failed solve.
  explicit DiagonalInverse(const Vector& diagonal);

  Teuchos::RCP<const Map> getDomainMap() const override { return inverse_.getMap(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return inverse_.getMap(); }
  /// y ← beta y + alpha D⁻¹ x
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1.0,
             double beta = 0.0) const override;
  bool hasTransposeApply() const override { return true; }

 private:
  Vector inverse_;
};

}  // namespace kiln
