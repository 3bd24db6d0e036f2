#pragma once

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The test space Ψ of a Petrov–Galerkin projection Ψᵀ r(u_ref + Φ û) = 0, on this rank's rows. Methods differ in it
/// and in nothing else.
class TestBasis {
 public:
  virtual ~TestBasis() = default;
  /// Ψ from the trial space's tangent Φ and from J̃Φ, the residual's Jacobian applied to it; both rows × components by
  /// M. The view may be one of the arguments or the test basis's own; it is true until the next call. Collective.
  virtual ConstMatrixView form(ConstMatrixView tangent, ConstMatrixView jacobian_tangent,
                               const Communicator& communicator) = 0;
};

/// Ψ = Φ: the residual is orthogonal to the trial space (Eq. 26).
class GalerkinTestBasis : public TestBasis {
 public:
  ConstMatrixView form(ConstMatrixView tangent, ConstMatrixView, const Communicator&) override { return tangent; }
};

/// Ψ = J̃Φ: Gauss–Newton on ‖r‖₂, least-squares Petrov–Galerkin (Eq. 27).
class LspgTestBasis : public TestBasis {
 public:
  ConstMatrixView form(ConstMatrixView, ConstMatrixView jacobian_tangent, const Communicator&) override {
    return jacobian_tangent;
  }
};

/// Ψ = AᵀA J̃Φ with A = [PΦ_r]⁺: Gauss–Newton on ‖A P r‖₂ (Eq. 32).
class GnatTestBasis : public TestBasis {
 public:
  /// gappy_operator: the columns of A at this rank's rows, residual modes × (rows × components).
  explicit GnatTestBasis(MatrixView gappy_operator);
  ConstMatrixView form(ConstMatrixView tangent, ConstMatrixView jacobian_tangent,
                       const Communicator& communicator) override;

 private:
  ConstMatrixView gappy_operator_;
  MatrixView gappy_operator_transposed_;  ///< products with columns of length n_p need no sums across a vector
  MatrixView reduced_, test_;
};

}  // namespace kiln
