#include "framework/solvers/StepJacobian.hpp"

#include <Tpetra_CrsGraph.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <stdexcept>
#include <utility>

#include "framework/solvers/JacobianAction.hpp"
#include "framework/solvers/StepOperator.hpp"

namespace kiln {
namespace {

void divide_by_step_diagonal(double alpha, double gamma, const ConstVectorView& diagonal, const ConstVectorView& r,
                             const VectorView& dx) {
  Kokkos::parallel_for(
      "kiln::solvers::divide_by_step_diagonal", RangePolicy(0, static_cast<LocalIndex>(r.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { dx(i) = r(i) / (alpha - gamma * diagonal(i)); });
}

void step_diagonal(double alpha, double gamma, const VectorView& diagonal) {
  Kokkos::parallel_for(
      "kiln::solvers::step_diagonal", RangePolicy(0, static_cast<LocalIndex>(diagonal.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { diagonal(i) = alpha - gamma * diagonal(i); });
}

VectorView column(const Teuchos::RCP<Vector>& vector) {
  return Kokkos::subview(vector->getLocalViewDevice(Tpetra::Access::ReadWrite), Kokkos::ALL, 0);
}

class DiagonalJacobian : public StepJacobian {
 public:
  DiagonalJacobian(const Model& model, const Halo& halo)
      : model_(model), diagonal_("kiln::solvers::rate Jacobian diagonal", halo.row_size()) {}

  void require_offered(ConstVectorView u) override { take(u, 0.0); }

  void take(ConstVectorView u, double time) override { model_.rate_jacobian_diagonal(u, time, diagonal_); }

  LinearSolveReport solve(double alpha, double gamma, ConstVectorView r, VectorView dx) override {
    divide_by_step_diagonal(alpha, gamma, diagonal_, r, dx);
    return {};
  }

 private:
  const Model& model_;
  VectorView diagonal_;
};

/// What all forms with a linear solver share: vectors, and the solve itself.
class KrylovJacobian : public StepJacobian {
 public:
  KrylovJacobian(const Model& model, const Halo& halo, std::shared_ptr<LinearSolver> solver)
      : model_(model),
        solver_(std::move(solver)),
        r_(Teuchos::rcp(new Vector(halo.rows()))),
        dx_(Teuchos::rcp(new Vector(halo.rows()))),
        diagonal_(solver_->needs_diagonal() ? Teuchos::rcp(new Vector(halo.rows())) : Teuchos::null) {}

 protected:
  LinearSolveReport solve_with(const Teuchos::RCP<const Operator>& a, ConstVectorView r, VectorView dx) {
    Kokkos::deep_copy(column(r_), r);
    dx_->putScalar(0.0);
    const LinearSolveReport report = solver_->solve(a, diagonal_, r_, dx_);
    Kokkos::deep_copy(dx, column(dx_));
    return report;
  }

  const Model& model_;
  std::shared_ptr<LinearSolver> solver_;
  Teuchos::RCP<Vector> r_, dx_, diagonal_;
};

class SparseJacobian : public KrylovJacobian {
 public:
  using KrylovJacobian::KrylovJacobian;

  void require_offered(ConstVectorView u) override { model_.rate_jacobian_matrix(u, 0.0); }

  void take(ConstVectorView u, double time) override {
    rate_jacobian_ = model_.rate_jacobian_matrix(u, time);
    if (matrix_.is_null() || matrix_->getCrsGraph() != rate_jacobian_->getCrsGraph()) build_matrix();
    current_ = false;
  }

  LinearSolveReport solve(double alpha, double gamma, ConstVectorView r, VectorView dx) override {
    if (!current_ || alpha != alpha_ || gamma != gamma_) assemble(alpha, gamma);
    return solve_with(matrix_, r, dx);
  }

 private:
  void build_matrix() {
    const auto graph = rate_jacobian_->getCrsGraph();
    matrix_ = Teuchos::rcp(new CrsMatrix(graph));
    matrix_->fillComplete(graph->getDomainMap(), graph->getRangeMap());
    const std::size_t rows = local_size(*graph->getRowMap());
    diagonal_entries_ = Kokkos::View<std::size_t*, Device>("kiln::solvers::diagonal entries", rows);
    const auto entries = Kokkos::create_mirror_view(diagonal_entries_);
    const auto local = graph->getLocalGraphHost();
    const Map& row_map = *graph->getRowMap();
    const Map& column_map = *graph->getColMap();
    for (std::size_t row = 0; row < rows; ++row) {
      const GlobalIndex id = row_map.getGlobalElement(static_cast<LocalIndex>(row));
      const LocalIndex diagonal = column_map.getLocalElement(id);
      std::size_t k = local.row_map(row);
      while (k < local.row_map(row + 1) && local.entries(k) != diagonal) ++k;
      if (k == local.row_map(row + 1)) {
        throw std::logic_error("rate_jacobian_matrix: row " + std::to_string(id) +
                               " of the graph has no entry on the diagonal; expected one in every row");
      }
      entries(row) = k;
    }
    Kokkos::deep_copy(diagonal_entries_, entries);
  }

  void assemble(double alpha, double gamma) {
    fill_matrix(alpha, gamma, rate_jacobian_->getLocalMatrixDevice().values, matrix_->getLocalMatrixDevice().values,
                diagonal_entries_);
    if (!diagonal_.is_null()) matrix_->getLocalDiagCopy(*diagonal_);
    alpha_ = alpha;
    gamma_ = gamma;
    current_ = true;
  }

  template <class ConstValues, class Values, class Entries>
  static void fill_matrix(double alpha, double gamma, const ConstValues& rate_jacobian, const Values& values,
                          const Entries& diagonal_entries) {
    Kokkos::parallel_for(
        "kiln::solvers::scale_rate_jacobian", Kokkos::RangePolicy<ExecutionSpace, std::size_t>(0, values.extent(0)),
        KOKKOS_LAMBDA(const std::size_t k) { values(k) = -gamma * rate_jacobian(k); });
    Kokkos::parallel_for(
        "kiln::solvers::add_to_diagonal",
        Kokkos::RangePolicy<ExecutionSpace, std::size_t>(0, diagonal_entries.extent(0)),
        KOKKOS_LAMBDA(const std::size_t row) { values(diagonal_entries(row)) += alpha; });
  }

  // The model's matrix keeps the frozen values: it is refilled by the next take() only.
  Teuchos::RCP<const CrsMatrix> rate_jacobian_;
  Teuchos::RCP<CrsMatrix> matrix_;
  Kokkos::View<std::size_t*, Device> diagonal_entries_;
  double alpha_ = 0.0, gamma_ = 0.0;
  bool current_ = false;
};

class OperatorJacobian : public KrylovJacobian {
 public:
  OperatorJacobian(JacobianForm form, const Model& model, const Halo& halo, std::shared_ptr<LinearSolver> solver)
      : KrylovJacobian(model, halo, std::move(solver)),
        action_(model, form),
        operator_(Teuchos::rcp(new StepOperator(halo, action_))) {
    if (!diagonal_.is_null()) rate_diagonal_ = VectorView("kiln::solvers::rate Jacobian diagonal", halo.row_size());
  }

  void require_offered(ConstVectorView u) override {
    action_.require_offered(u);
    if (!diagonal_.is_null()) model_.rate_jacobian_diagonal(u, 0.0, rate_diagonal_);
  }

  void take(ConstVectorView u, double time) override {
    action_.take(u, time);
    if (!diagonal_.is_null()) model_.rate_jacobian_diagonal(u, time, rate_diagonal_);
  }

  LinearSolveReport solve(double alpha, double gamma, ConstVectorView r, VectorView dx) override {
    operator_->set(alpha, gamma);
    if (!diagonal_.is_null()) {
      const VectorView diagonal = column(diagonal_);
      Kokkos::deep_copy(diagonal, rate_diagonal_);
      step_diagonal(alpha, gamma, diagonal);
    }
    return solve_with(operator_, r, dx);
  }

  long long rate_evaluations() const override { return action_.rate_evaluations(); }

 private:
  JacobianAction action_;
  Teuchos::RCP<StepOperator> operator_;
  VectorView rate_diagonal_;
};

}  // namespace

std::unique_ptr<StepJacobian> StepJacobian::create(JacobianForm form, const Model& model, const Halo& halo,
                                                   std::shared_ptr<LinearSolver> solver) {
  if (form == JacobianForm::diagonal) return std::make_unique<DiagonalJacobian>(model, halo);
  if (!solver) throw std::invalid_argument("a " + to_text(form) + " Jacobian needs a linear solver");
  if (form == JacobianForm::sparse) return std::make_unique<SparseJacobian>(model, halo, std::move(solver));
  return std::make_unique<OperatorJacobian>(form, model, halo, std::move(solver));
}

}  // namespace kiln
