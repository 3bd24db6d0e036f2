#pragma once

#include <BelosSolverManager.hpp>

#include "framework/solvers/LinearSolver.hpp"

namespace kiln {

/// Krylov methods of Belos, with an optional Jacobi preconditioner D⁻¹ from the operator's diagonal D.
class Krylov : public LinearSolver {
 public:
  bool needs_diagonal() const override { return jacobi_; }
  /// A breakdown or NaN inside Belos is a solve that did not converge. Throws std::invalid_argument for a null diagonal
  /// where one is needed.
  LinearSolveReport solve(const Teuchos::RCP<const Operator>& a, const Teuchos::RCP<const Vector>& diagonal,
                          const Teuchos::RCP<const MultiVector>& b, const Teuchos::RCP<MultiVector>& x) override;

 protected:
  using Manager = Belos::SolverManager<double, MultiVector, Operator>;
  /// `tolerance`, `iterations` and `preconditioner`.
  static Specification common_specification();
  Krylov(std::string name, const Teuchos::ParameterList& list, Teuchos::RCP<Manager> manager);
  /// The parameters Belos wants, for every manager.
  Teuchos::RCP<Teuchos::ParameterList> belos_parameters() const;
  void set_parameters(const Teuchos::RCP<Teuchos::ParameterList>& parameters) { manager_->setParameters(parameters); }

 private:
  std::string name_;
  double tolerance_;
  int iterations_;
  bool jacobi_;
  Teuchos::RCP<Manager> manager_;
};

/// Restarted GMRES: any matrix.
class Gmres : public Krylov {
 public:
  static Specification specification();
  Gmres(const Teuchos::ParameterList& list, const Context& context);
};

/// Conjugate gradients: symmetric positive definite matrices.
class ConjugateGradient : public Krylov {
 public:
  static Specification specification();
  ConjugateGradient(const Teuchos::ParameterList& list, const Context& context);
};

/// BiCGStab: any matrix, short recurrences.
class BiCgStab : public Krylov {
 public:
  static Specification specification();
  BiCgStab(const Teuchos::ParameterList& list, const Context& context);
};

}  // namespace kiln
