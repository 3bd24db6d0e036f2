#pragma once

#include <string>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {

/// What one linear solve did.
struct LinearSolveReport {
  int iterations = 0;
  double relative_residual = 0.0;  ///< ‖b − A x‖/‖b‖: the solver's own figure, recomputed for a failed solve
  bool converged = true;
  std::string problem;  ///< solver's name, what it reached and what was asked for; empty when converged
};

/// Solves A x = b for the operators of implicit steps. `time.newton.linear_solver: {type: …}` picks one.
class LinearSolver {
 public:
  using Context = NoContext;
  static constexpr const char* category = "linear solver";

  virtual ~LinearSolver() = default;

  /// Whether solve() wants A's diagonal.
  virtual bool needs_diagonal() const = 0;
  /// Solves from the guess in x. `diagonal` is A's, or null when needs_diagonal() is false; A stands over its map. A
  /// solve that fails says so in the report: the caller decides, with its own place in the message. Collective.
  virtual LinearSolveReport solve(const Teuchos::RCP<const Operator>& a, const Teuchos::RCP<const Vector>& diagonal,
                                  const Teuchos::RCP<const MultiVector>& b, const Teuchos::RCP<MultiVector>& x) = 0;
};

}  // namespace kiln
