#include "framework/solvers/Krylov.hpp"

#include <fmt/format.h>

#include <BelosBiCGStabSolMgr.hpp>
#include <BelosLinearProblem.hpp>
#include <BelosMultiVecTraits_Tpetra.hpp>
#include <BelosOperatorTraits_Tpetra.hpp>
#include <BelosPseudoBlockCGSolMgr.hpp>
#include <BelosPseudoBlockGmresSolMgr.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>
#include <limits>
#include <stdexcept>

#include "framework/solvers/DiagonalInverse.hpp"

namespace kiln {
namespace {

/// ‖b − A x‖/‖b‖ of the first column.
double relative_residual(const Operator& a, const MultiVector& b, const MultiVector& x) {
  MultiVector residual(b, Teuchos::Copy);
  a.apply(x, residual, Teuchos::NO_TRANS, -1.0, 1.0);
  return residual.getVector(0)->norm2() / b.getVector(0)->norm2();
}

}  // namespace

Specification Krylov::common_specification() {
  Specification s;
  s.real("tolerance", "residual norm at which a system is solved, relative to its right-hand side")
      .above(0)
      .below(1)
      .defaults_to(1e-6);
  s.integer("iterations", "cap on iterations a system").at_least(1).defaults_to(500);
  s.choice("preconditioner", "jacobi divides by the diagonal, which the model must offer", {"none", "jacobi"})
      .defaults_to("none");
  return s;
}

Krylov::Krylov(std::string name, const Teuchos::ParameterList& list, Teuchos::RCP<Manager> manager)
    : name_(std::move(name)),
      tolerance_(list.get<double>("tolerance")),
      iterations_(list.get<int>("iterations")),
      jacobi_(list.get<std::string>("preconditioner") == "jacobi"),
      manager_(std::move(manager)) {}

Teuchos::RCP<Teuchos::ParameterList> Krylov::belos_parameters() const {
  auto parameters = Teuchos::parameterList();
  parameters->set("Convergence Tolerance", tolerance_);
  parameters->set("Maximum Iterations", iterations_);
  return parameters;
}

LinearSolveReport Krylov::solve(const Teuchos::RCP<const Operator>& a, const Teuchos::RCP<const Vector>& diagonal,
                                const Teuchos::RCP<const MultiVector>& b, const Teuchos::RCP<MultiVector>& x) {
  auto problem = Teuchos::rcp(new Belos::LinearProblem<double, MultiVector, Operator>(a, x, b));
  if (jacobi_) {
    if (diagonal.is_null()) throw std::invalid_argument(name_ + " with a Jacobi preconditioner got no diagonal");
    problem->setRightPrec(Teuchos::rcp(new DiagonalInverse(*diagonal)));
  }
  problem->setProblem();
  LinearSolveReport report;
  std::string why;
  try {
    manager_->setProblem(problem);
    report.converged = manager_->solve() == Belos::Converged;
    report.relative_residual = manager_->achievedTol();
    if (!report.converged) {
      // Belos gives up where its recursive residual has lost accuracy, and that figure is no longer the residual's.
      report.relative_residual = relative_residual(*a, *b, *x);
      report.converged = report.relative_residual <= tolerance_;
      if (!report.converged) why = fmt::format("reached a relative residual of {:.3g}", report.relative_residual);
    }
  } catch (const Belos::BelosError&) {
    // Belos throws for NaN and for a direction without curvature; its texts name its own source lines only.
    report.converged = false;
    report.relative_residual = std::numeric_limits<double>::quiet_NaN();
    why = "broke down: a value is not finite, or the matrix is not what this method needs";
  }
  report.iterations = manager_->getNumIters();
  if (!report.converged) {
    report.problem = fmt::format("linear solver '{}' {} in {} iterations; expected {:.3g} within {}", name_, why,
                                 report.iterations, tolerance_, iterations_);
  }
  return report;
}

Specification Gmres::specification() {
  Specification s = common_specification();
  s.integer("restart", "basis vectors kept before a restart").at_least(1).defaults_to(50);
  return s;
}

Gmres::Gmres(const Teuchos::ParameterList& list, const Context&)
    : Krylov("gmres", list, Teuchos::rcp(new Belos::PseudoBlockGmresSolMgr<double, MultiVector, Operator>)) {
  const auto parameters = belos_parameters();
  const int restart = list.get<int>("restart");
  parameters->set("Num Blocks", restart);
  // Belos counts whole restart cycles; this many hold the cap of iterations.
  parameters->set("Maximum Restarts", list.get<int>("iterations") / restart + 1);
  set_parameters(parameters);
}

Specification ConjugateGradient::specification() { return common_specification(); }

ConjugateGradient::ConjugateGradient(const Teuchos::ParameterList& list, const Context&)
    : Krylov("cg", list, Teuchos::rcp(new Belos::PseudoBlockCGSolMgr<double, MultiVector, Operator>)) {
  set_parameters(belos_parameters());
}

Specification BiCgStab::specification() { return common_specification(); }

BiCgStab::BiCgStab(const Teuchos::ParameterList& list, const Context&)
    : Krylov("bicgstab", list, Teuchos::rcp(new Belos::BiCGStabSolMgr<double, MultiVector, Operator>)) {
  set_parameters(belos_parameters());
}

KILN_REGISTER(LinearSolver, Gmres, "gmres", "restarted GMRES (Belos), for any matrix");
KILN_REGISTER(LinearSolver, ConjugateGradient, "cg",
              "conjugate gradients (Belos), for symmetric positive definite matrices");
KILN_REGISTER(LinearSolver, BiCgStab, "bicgstab", "stabilised biconjugate gradients (Belos), for any matrix");

}  // namespace kiln
