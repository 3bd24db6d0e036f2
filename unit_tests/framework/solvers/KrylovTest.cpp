#include "framework/solvers/Krylov.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "framework/solvers/DiagonalInverse.hpp"

namespace kiln {
namespace {

constexpr GlobalIndex size = 60;

Teuchos::RCP<const Map> map() { return Teuchos::rcp(new Map(size, 0, Tpetra::getDefaultComm())); }

/// Bounds ‖x − x*‖/‖x*‖ for a residual of 1e-12: tridiagonal()'s condition number is below 1e4.
constexpr double error_bound = 1e4 * 1e-12;

/// Tridiagonal, diagonally dominant with a diagonal that grows 1000-fold; `skew` makes it unsymmetric.
Teuchos::RCP<CrsMatrix> tridiagonal(double skew) {
  const auto rows = map();
  const auto matrix = Teuchos::rcp(new CrsMatrix(rows, 3));
  for (LocalIndex i = 0; i < local_size(*rows); ++i) {
    const GlobalIndex row = rows->getGlobalElement(i);
    const double diagonal = 2.1 + 1000.0 * static_cast<double>(row * row) / (size * size);
    if (row > 0) matrix->insertGlobalValues(row, Teuchos::tuple(row - 1), Teuchos::tuple(-1.0 - skew));
    matrix->insertGlobalValues(row, Teuchos::tuple(row), Teuchos::tuple(diagonal));
    if (row + 1 < size) matrix->insertGlobalValues(row, Teuchos::tuple(row + 1), Teuchos::tuple(-1.0 + skew));
  }
  matrix->fillComplete();
  return matrix;
}

Teuchos::ParameterList settings(const std::string& type, double tolerance, int iterations,
                                const std::string& preconditioner) {
  Teuchos::ParameterList list("time.newton.linear_solver");
  list.set("type", type);
  list.set("tolerance", tolerance);
  list.set("iterations", iterations);
  list.set("preconditioner", preconditioner);
  if (type == "gmres") list.set("restart", 60);
  return list;
}

struct Outcome {
  LinearSolveReport report;
  double error;
};

/// Solves for a right-hand side made from a known solution.
Outcome solve(const std::string& type, double skew, double tolerance = 1e-12, int iterations = 300,
              const std::string& preconditioner = "none") {
  const auto a = tridiagonal(skew);
  const auto exact = Teuchos::rcp(new Vector(a->getDomainMap()));
  for (LocalIndex i = 0; i < local_size(*exact->getMap()); ++i) {
    exact->replaceLocalValue(i, std::sin(1.0 + exact->getMap()->getGlobalElement(i)));
  }
  const auto b = Teuchos::rcp(new Vector(a->getRangeMap()));
  a->apply(*exact, *b);
  const auto x = Teuchos::rcp(new Vector(a->getDomainMap()));
  const auto diagonal = Teuchos::rcp(new Vector(a->getRangeMap()));
  a->getLocalDiagCopy(*diagonal);
  const auto solver = Registry<LinearSolver>::create(settings(type, tolerance, iterations, preconditioner), {});
  EXPECT_EQ(solver->needs_diagonal(), preconditioner == "jacobi");
  Outcome outcome{solver->solve(a, solver->needs_diagonal() ? diagonal : Teuchos::null, b, x), 0.0};
  x->update(-1.0, *exact, 1.0);
  outcome.error = x->norm2() / exact->norm2();
  return outcome;
}

class EachSolver : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Krylov, EachSolver, testing::Values("gmres", "cg", "bicgstab"));

TEST_P(EachSolver, SolvesASymmetricSystem) {
  const Outcome outcome = solve(GetParam(), 0.0);
  EXPECT_TRUE(outcome.report.converged);
  EXPECT_EQ(outcome.report.problem, "");
  EXPECT_LT(outcome.error, error_bound);
}

TEST_P(EachSolver, JacobiSavesIterations) {
  const Outcome plain = solve(GetParam(), 0.0), jacobi = solve(GetParam(), 0.0, 1e-12, 300, "jacobi");
  EXPECT_TRUE(jacobi.report.converged);
  EXPECT_LT(jacobi.error, error_bound);
  EXPECT_LT(jacobi.report.iterations, 0.7 * plain.report.iterations);
}

TEST_P(EachSolver, NamesASolveThatStopsShort) {
  const Outcome outcome = solve(GetParam(), 0.0, 1e-12, 3);
  EXPECT_FALSE(outcome.report.converged);
  EXPECT_GT(outcome.report.relative_residual, 1e-12);
  const std::string& problem = outcome.report.problem;
  EXPECT_NE(problem.find(std::string("'") + GetParam() + "'"), std::string::npos) << problem;
  EXPECT_NE(problem.find("3 iterations; expected 1e-12 within 3"), std::string::npos) << problem;
}

TEST_P(EachSolver, NamesABreakdown) {
  const auto a = tridiagonal(0.0);
  const auto b = Teuchos::rcp(new Vector(a->getRangeMap()));
  b->putScalar(std::nan(""));
  const auto x = Teuchos::rcp(new Vector(a->getDomainMap()));
  const auto solver = Registry<LinearSolver>::create(settings(GetParam(), 1e-6, 200, "none"), {});
  const LinearSolveReport report = solver->solve(a, Teuchos::null, b, x);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.problem.find(GetParam()), std::string::npos) << report.problem;
  // The same object solves the next system.
  b->putScalar(1.0);
  x->putScalar(0.0);
  EXPECT_TRUE(solver->solve(a, Teuchos::null, b, x).converged);
}

TEST(Krylov, UnsymmetricSystemsNeedMoreThanCg) {
  for (const char* type : {"gmres", "bicgstab"}) {
    const Outcome outcome = solve(type, 0.9);
    EXPECT_TRUE(outcome.report.converged) << type << ": " << outcome.report.problem;
    EXPECT_LT(outcome.error, error_bound) << type;
  }
}

TEST(Krylov, AnIndefiniteMatrixIsReportedByCg) {
  const auto a = tridiagonal(0.0);
  a->resumeFill();
  a->scale(-1.0);
  a->fillComplete();
  const auto b = Teuchos::rcp(new Vector(a->getRangeMap()));
  b->putScalar(1.0);
  const auto x = Teuchos::rcp(new Vector(a->getDomainMap()));
  const auto solver = Registry<LinearSolver>::create(settings("cg", 1e-6, 100, "none"), {});
  const LinearSolveReport report = solver->solve(a, Teuchos::null, b, x);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.problem.find("broke down"), std::string::npos) << report.problem;
}

TEST(Krylov, AJacobiPreconditionerNeedsTheDiagonal) {
  const auto a = tridiagonal(0.0);
  const auto b = Teuchos::rcp(new Vector(a->getRangeMap()));
  const auto x = Teuchos::rcp(new Vector(a->getDomainMap()));
  const auto solver = Registry<LinearSolver>::create(settings("gmres", 1e-6, 100, "jacobi"), {});
  EXPECT_THROW(solver->solve(a, Teuchos::null, b, x), std::invalid_argument);
}

TEST(DiagonalInverse, Applies) {
  Vector diagonal(map()), x(map()), y(map());
  diagonal.putScalar(4.0);
  x.putScalar(2.0);
  y.putScalar(10.0);
  DiagonalInverse(diagonal).apply(x, y, Teuchos::NO_TRANS, 3.0, 0.5);
  for (LocalIndex i = 0; i < local_size(*y.getMap()); ++i) EXPECT_EQ(y.getData()[i], 6.5);
}

}  // namespace
}  // namespace kiln
