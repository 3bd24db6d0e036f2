#pragma once

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The time-discrete residual of one step (Eq. 14) on this rank's rows,
///
///     r(ξ) = α0 ξ − Δt β0 f(ξ, t) + h,   ∂r/∂ξ = α0 I − Δt β0 ∂f/∂u,
///
/// where h = Σ_{j≥1} α_j u^{n−j} − Δt Σ_{j≥1} β_j f(u^{n−j}, t^{n−j}) gathers what is known. This pair is all that
/// Newton, Galerkin, LSPG and GNAT see of a time scheme.
struct StepResidual {
  double alpha;             ///< α0
  double gamma;             ///< Δt β0 in s; 0 for an explicit scheme
  double time;              ///< t^n in s, where f is evaluated
  ConstVectorView history;  ///< h, rows × components
};

/// What one step's solve did.
struct SolveReport {
  int residuals = 0;        ///< evaluations of f
  int iterations = 0;       ///< updates of the unknown
  bool converged = true;    ///< false: the iteration cap came first
  double first_norm = 0.0;  ///< norm of the (reduced) residual before the first update
  double last_norm = 0.0;   ///< and at the accepted state
};

}  // namespace kiln
