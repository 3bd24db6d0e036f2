#include "rom/projection/Projection.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/base/Loop.hpp"
#include "framework/method/Divergence.hpp"

namespace kiln {
namespace {

// A label made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string residual_label = "kiln::rom::residual";

template <class Rate>
void form_residual(const StepResidual& step, const VectorView& state, const Rate& rate, const VectorView& residual) {
  const double alpha = step.alpha, gamma = step.gamma;
  const auto history = borrowed(step.history);
  const auto u = borrowed(state);
  const auto f = borrowed(rate);
  const auto r = borrowed(residual);
  loop(
      residual_label, static_cast<LocalIndex>(r.extent(0)),
      KOKKOS_LAMBDA(const LocalIndex i) { r(i) = alpha * u(i) - gamma * f(i) + history(i); });
}

double squares_of(const double* values, std::size_t count) {
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += values[k] * values[k];
  return sum;
}

double norm_of(const VectorView& values) { return std::sqrt(squares_of(values.data(), values.extent(0))); }

void copy(const ConstVectorView& from, const VectorView& to) { std::copy_n(from.data(), to.extent(0), to.data()); }

}  // namespace

Projection::Projection(Parts parts, const NewtonSettings& settings, Factors factors)
    : model_(std::move(parts.model)),
      trial_(std::move(parts.trial)),
      test_basis_(std::move(parts.test)),
      settings_(settings),
      communicator_(model_->rows()->getComm()),
      first_(trial_->first()),
      size_(trial_->size()),
      when_factored_(factors),
      jacobian_(*model_, settings.jacobian) {
  const std::size_t components = model_->fields().size();
  const std::size_t rows = local_size(*model_->rows()) * components;
  row_size_ = static_cast<LocalIndex>(rows);
  jacobian_tangent_ = MatrixView("kiln::rom::J Phi", rows, size_);
  small_ = MatrixView("kiln::rom::reduced Jacobian", size_, size_);
  state_ = VectorView("kiln::rom::state of the sources", local_size(*model_->sources()) * components);
  rate_ = VectorView("kiln::rom::rate", rows);
  residual_ = VectorView("kiln::rom::residual", rows);
  g_ = VectorView("kiln::rom::reduced residual", size_);
  local_g_ = VectorView("kiln::rom::reduced residual of this rank", size_);
  step_ = VectorView("kiln::rom::update", size_);
}

void Projection::require_jacobian() const {
  const VectorView sources("kiln::rom::initial", state_.extent(0));
  model_->initial_state(sources);
  jacobian_.require_offered(sources);
}

void Projection::initial(VectorView x) const {
  Kokkos::deep_copy(x, 0.0);
  VectorView reference("kiln::rom::reference", state_.extent(0)), difference("kiln::rom::initial", state_.extent(0));
  trial_->state(x, reference);
  model_->initial_state(difference);
  double differs = 0.0;
  for (LocalIndex i = 0; i < row_size_; ++i) {
    difference(i) -= reference(i);
    if (difference(i) != 0.0) differs = 1.0;
  }
  sum_over_ranks(*communicator_, &differs, 1);
  if (differs == 0.0) return;

  const ConstMatrixView tangent = dense::row_block(trial_->tangent(x), 0, row_size_);
  MatrixView normal = dense::gram(tangent);
  sum_over_ranks(*communicator_, normal.data(), normal.size());
  const VectorView own = Kokkos::subview(x, std::make_pair(first_, first_ + size_));
  dense::multiply_transposed(1.0, tangent, Kokkos::subview(difference, std::make_pair(0, row_size_)), 0.0, own);
  sum_over_ranks(*communicator_, own.data(), own.size());
  dense::LuFactors factors;
  if (!(factors.factor(normal) > 1e-14)) {
    throw DivergenceError("the initial state cannot be told in the trial space: its rows are dependent", 0.0);
  }
  factors.solve(own);
}

void Projection::evaluate(ConstVectorView x, double time, VectorView u, VectorView f) {
  trial_->state(x, state_);
  model_->rate(state_, time, f);
  copy(state_, u);
}

bool Projection::linearised_for(double alpha, double gamma) const {
  return frozen_.age >= 0 && frozen_.alpha == alpha && frozen_.gamma == gamma && (trial_->affine() || gamma != 0.0);
}

void Projection::factor(double time) {
  test_ = test_basis_->form(tangent_rows_, jacobian_tangent_, *communicator_);
  dense::product(dense::Transpose::yes, dense::Transpose::no, 1.0, test_, jacobian_tangent_, 0.0, small_);
  sum_over_ranks(*communicator_, small_.data(), small_.size());
  reciprocal_condition_ = factors_.factor(small_);
  require_regular(reciprocal_condition_, time);
  double squares = 0.0;
  for (std::size_t k = 0; k < test_.extent(1); ++k) squares += squares_of(&test_(0, k), test_.extent(0));
  test_norm_ = root_of_sum(*communicator_, squares);
}

double Projection::goal(double tolerance, double first_norm, double test_norm, double history_norm) {
  return std::max(tolerance * first_norm, 4.0 * std::numeric_limits<double>::epsilon() * test_norm * history_norm);
}

void Projection::require_regular(double reciprocal_condition, double time) {
  if (reciprocal_condition > 1e-15) return;
  throw DivergenceError("the reduced Jacobian is singular to round-off: basis vectors are dependent at the rows", time);
}

void Projection::linearise(double alpha, double gamma, ConstVectorView x, double time) {
  const ConstMatrixView tangent = trial_->tangent(x);
  tangent_rows_ = dense::row_block(tangent, 0, row_size_);
  if (gamma != 0.0) {
    trial_->state(x, state_);
    jacobian_.take(state_, time);
    jacobian_.apply(tangent, jacobian_tangent_);
  }
  for (std::size_t k = 0; k < tangent.extent(1); ++k) {
    for (LocalIndex i = 0; i < row_size_; ++i) {
      const double rate_part = gamma != 0.0 ? gamma * jacobian_tangent_(i, k) : 0.0;
      jacobian_tangent_(i, k) = alpha * tangent_rows_(i, k) - rate_part;
    }
  }
  factor(time);
  if (frozen_.x.extent(0) != x.extent(0)) frozen_.x = VectorView("kiln::rom::frozen coordinates", x.extent(0));
  copy(x, frozen_.x);
  frozen_.alpha = alpha;
  frozen_.gamma = gamma;
  frozen_.time = time;
  frozen_.age = 0;
  ++linearisations_;
}

void Projection::project(const VectorView& rows, const VectorView& g) {
  if (communicator_->getSize() == 1) return dense::transposed(test_, rows.data(), g.data());
  dense::transposed(test_, rows.data(), local_g_.data());
  Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_SUM, static_cast<int>(g.extent(0)), local_g_.data(), g.data());
}

void Projection::move(VectorView x, double scale) const {
  for (int i = 0; i < size_; ++i) x(first_ + i) += scale * step_(i);
}

int Projection::rate(ConstVectorView x, double time, VectorView dxdt) {
  if (!linearised_for(1.0, 0.0)) linearise(1.0, 0.0, x, time);
  trial_->state(x, state_);
  model_->rate(state_, time, rate_);
  if (observer_) observer_(rate_);
  project(rate_, g_);
  if (!std::isfinite(norm_of(g_))) throw_diverged("the rate is not finite", time, rate_, rate_);
  factors_.solve(g_);
  Kokkos::deep_copy(dxdt, 0.0);
  std::copy_n(g_.data(), size_, dxdt.data() + first_);
  return 1;
}

double Projection::reduced_residual(const StepResidual& residual, ConstVectorView x, VectorView f) {
  trial_->state(x, state_);
  model_->rate(state_, residual.time, f);
  form_residual(residual, state_, f, residual_);
  project(residual_, g_);
  const double norm = norm_of(g_);
  if (observer_ && std::isfinite(norm)) observer_(residual_);
  return norm;
}

double Projection::search_line(const StepResidual& residual, VectorView x, VectorView f, double norm, double next,
                               SolveReport& report) {
  double fraction = 1.0;
  for (int k = 0; k < NewtonSettings::halvings && !(next < norm); ++k) {
    fraction *= 0.5;
    move(x, fraction);
    next = reduced_residual(residual, x, f);
    ++report.residuals;
  }
  return next;
}

SolveReport Projection::solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f) {
  const bool frozen_serves = residual.gamma == 0.0 || frozen_.age < settings_.refresh;
  if (!linearised_for(residual.alpha, residual.gamma) || !frozen_serves) {
    linearise(residual.alpha, residual.gamma, x, residual.time);
  }
  ++frozen_.age;
  if (residual.gamma == 0.0 && trial_->affine()) return solve_explicit(residual, x, u, f);

  SolveReport report;
  double norm = reduced_residual(residual, x, f);
  if (!std::isfinite(norm)) throw_diverged(not_finite, residual.time, f, residual_);
  report.residuals = 1;
  report.first_norm = norm;
  const double goal =
      this->goal(settings_.tolerance, norm, test_norm_,
                 root_of_sum(*communicator_, squares_of(residual.history.data(), residual.history.extent(0))));
  bool descending = true;
  while (norm > goal && report.iterations < settings_.iterations && descending) {
    if (when_factored_ == Factors::every_iteration) factor(residual.time);
    copy(g_, step_);
    factors_.solve(step_);
    move(x, -1.0);
    ++report.iterations;
    double next = reduced_residual(residual, x, f);
    ++report.residuals;
    if (settings_.line_search) {
      next = search_line(residual, x, f, norm, next, report);
      descending = next < norm;
    }
    norm = next;
    if (!std::isfinite(norm)) throw_diverged(not_finite, residual.time, f, residual_);
    if (norm > growth_limit * report.first_norm) {
      throw_diverged(grown, residual.time, f, residual_);
    }
  }
  report.last_norm = norm;
  report.converged = norm <= goal;
  copy(state_, u);
  return report;
}

SolveReport Projection::solve_explicit(const StepResidual& residual, VectorView x, VectorView u, VectorView f) {
  trial_->state(x, state_);
  // The rate's factor is zero; any finite array may stand for it.
  form_residual(residual, state_, residual.history, residual_);
  if (observer_) observer_(residual_);
  project(residual_, g_);
  SolveReport report;
  report.first_norm = norm_of(g_);
  if (!std::isfinite(report.first_norm)) {
    throw_diverged(not_finite, residual.time, residual.history, residual_);
  }
  copy(g_, step_);
  factors_.solve(step_);
  move(x, -1.0);
  evaluate(x, residual.time, u, f);
  report.residuals = report.iterations = 1;
  return report;
}

void Projection::throw_diverged(const std::string& what, double time, ConstVectorView f,
                                ConstVectorView measure) const {
  throw divergence(*model_, what, time, Kokkos::subview(state_, std::make_pair(LocalIndex(0), row_size_)), f, measure);
}

}  // namespace kiln
