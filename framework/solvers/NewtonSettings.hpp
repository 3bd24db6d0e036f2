#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>

#include "framework/registry/Specification.hpp"

namespace kiln {

/// Which approximation of ∂f/∂u an implicit step uses. Full-order Newton and the reduced Gauss–Newton read the same
/// choice: `diagonal` needs Model::rate_jacobian_diagonal, `sparse` rate_jacobian_matrix (reductions:
/// apply_rate_jacobian), `matrix_free` apply_rate_jacobian, `finite_difference` nothing but rate.
enum class JacobianForm { diagonal, sparse, matrix_free, finite_difference };

/// The form as the input writes it, e.g. "matrix free".
std::string to_text(JacobianForm form);

/// The block `time.newton`: how a step's nonlinear system is solved, full order or reduced.
struct NewtonSettings {
  double tolerance = 1e-3;  ///< of the residual norm, relative to the step's first one
  int iterations = 10;      ///< cap on updates a step
  JacobianForm jacobian = JacobianForm::diagonal;
  int refresh = 10;                    ///< steps between two evaluations of the Jacobian; 1: every step
  bool line_search = false;            ///< halve an update until the residual norm falls
  static constexpr int halvings = 10;  ///< of one update at most; the step ends where none of them helps

  /// The report's settings, which are the input's defaults too.
  NewtonSettings() = default;
  /// A checked block `time.newton`.
  explicit NewtonSettings(const Teuchos::ParameterList& list);
  /// Also holds `linear_solver`, a component of category "linear solver", read by the full-order method.
  static Specification specification();
};

}  // namespace kiln
