#include "framework/method/FullOrder.hpp"

#include <fmt/format.h>

#include <Teuchos_TimeMonitor.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/base/Loop.hpp"
#include "framework/base/ViewOf.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Unknown.hpp"
#include "framework/method/Divergence.hpp"
#include "framework/model/SumsOverRun.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

Teuchos::TimeMonitor timed(const char* name) {
  return Teuchos::TimeMonitor(*Teuchos::TimeMonitor::getNewCounter(name));
}

/// r = α0 x − γ f + h; returns this rank's Σ r².
double residual_squares(const StepResidual& step, const ConstVectorView& x, const ConstVectorView& f,
                        const VectorView& r) {
  static const std::string label = "kiln::method::step_residual";
  const double alpha = step.alpha, gamma = step.gamma;
  const auto h = borrowed(step.history);
  const auto u = borrowed(x);
  const auto rate = borrowed(f);
  const auto residual = borrowed(r);
  return sum(
      label, static_cast<LocalIndex>(r.extent(0)), KOKKOS_LAMBDA(const LocalIndex i) {
        const double value = alpha * u(i) - gamma * rate(i) + h(i);
        residual(i) = value;
        return value * value;
      });
}

double squares(const ConstVectorView& values) {
  static const std::string label = "kiln::method::squares";
  const auto all = borrowed(values);
  return sum(
      label, static_cast<LocalIndex>(values.extent(0)), KOKKOS_LAMBDA(const LocalIndex i) { return all(i) * all(i); });
}

void add_scaled(const ConstVectorView& x, double scale, const ConstVectorView& direction, const VectorView& result) {
  Kokkos::parallel_for(
      "kiln::method::add_scaled", RangePolicy(0, static_cast<LocalIndex>(x.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { result(i) = x(i) + scale * direction(i); });
}

void scale(double factor, const ConstVectorView& values, const VectorView& result) {
  Kokkos::parallel_for(
      "kiln::method::scale", RangePolicy(0, static_cast<LocalIndex>(values.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { result(i) = factor * values(i); });
}

std::shared_ptr<LinearSolver> linear_solver(const Teuchos::ParameterList& newton) {
  return Registry<LinearSolver>::create(newton.sublist("linear_solver"), NoContext{});
}

}  // namespace

Specification FullOrder::specification() { return {}; }

FullOrder::FullOrder(const Teuchos::ParameterList&, const Context& context)
    : FullOrder(std::shared_ptr<Model>(
                    Registry<Model>::create(context.input.sublist("model"), Model::Context{context.communicator})),
                NewtonSettings(context.input.sublist("time").sublist("newton")),
                linear_solver(context.input.sublist("time").sublist("newton"))) {}

FullOrder::FullOrder(std::shared_ptr<Model> model, const NewtonSettings& settings, std::shared_ptr<LinearSolver> solver)
    : model_(std::move(model)),
      settings_(settings),
      halo_(*model_),
      state_(halo_),
      jacobian_(StepJacobian::create(settings.jacobian, *model_, halo_, std::move(solver))),
      residual_("kiln::method::residual", halo_.row_size()),
      update_("kiln::method::update", halo_.row_size()),
      frozen_x_("kiln::method::frozen state", halo_.row_size()) {
  if (settings_.line_search) trial_ = VectorView("kiln::method::trial state", halo_.row_size());
}

void FullOrder::initial(VectorView x) const {
  const VectorView sources("kiln::method::initial state", halo_.source_size());
  model_->initial_state(sources);
  Kokkos::deep_copy(x, Kokkos::subview(sources, std::make_pair(LocalIndex(0), halo_.row_size())));
}

void FullOrder::forget() {
  age_ = -1;
  if (auto* sums = dynamic_cast<SumsOverRun*>(model_.get())) sums->begin_run();
}

std::vector<std::string> FullOrder::warnings() const {
  const auto* sums = dynamic_cast<const SumsOverRun*>(model_.get());
  return sums == nullptr || resumed_ ? std::vector<std::string>{} : sums->warnings();
}

void FullOrder::require_jacobian() {
  const VectorView sources("kiln::method::initial state", halo_.source_size());
  model_->initial_state(sources);
  jacobian_->require_offered(sources);
  forget();
}

void FullOrder::rate_at(ConstVectorView x, double time, VectorView f) {
  Kokkos::deep_copy(state_.rows(), x);
  {
    const auto timer = timed("kiln: halo exchange");
    state_.fill();
  }
  const auto timer = timed("kiln: rate");
  model_->rate(state_.sources(), time, f);
}

void FullOrder::evaluate(ConstVectorView x, double time, VectorView u, VectorView f) {
  rate_at(x, time, f);
  Kokkos::deep_copy(u, x);
}

int FullOrder::rate(ConstVectorView x, double time, VectorView dxdt) {
  rate_at(x, time, dxdt);
  if (!all_finite(*halo_.rows()->getComm(), x, dxdt)) {
    throw divergence(*model_, "the rate is not finite", time, x, dxdt, dxdt);
  }
  return 1;
}

double FullOrder::norm_at(const StepResidual& residual, ConstVectorView x, VectorView f) {
  rate_at(x, residual.time, f);
  return root_of_sum(*model_->rows()->getComm(), residual_squares(residual, x, f, residual_));
}

SolveReport FullOrder::solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f) {
  const SolveReport report = residual.gamma == 0.0 ? solve_explicit(residual, x, f) : solve_implicit(residual, x, f);
  Kokkos::deep_copy(u, x);
  return report;
}

SolveReport FullOrder::solve_explicit(const StepResidual& residual, VectorView x, VectorView f) {
  scale(-1.0 / residual.alpha, residual.history, x);
  rate_at(x, residual.time, f);
  if (!all_finite(*halo_.rows()->getComm(), x, f)) {
    throw divergence(*model_, "the state or its rate is not finite", residual.time, x, f, f);
  }
  SolveReport report;
  report.residuals = 1;
  return report;
}

SolveReport FullOrder::solve_implicit(const StepResidual& residual, VectorView x, VectorView f) {
  if (age_ >= 0) ++age_;
  SolveReport report;
  double norm = norm_at(residual, x, f);
  report.residuals = 1;
  report.first_norm = norm;
  if (!std::isfinite(norm)) {
    throw divergence(*model_, "the residual is not finite", residual.time, x, f, residual_);
  }
  // r is a difference of terms as large as h; below their round-off no update can bring it.
  const double round_off =
      4.0 * std::numeric_limits<double>::epsilon() * root_of_sum(*model_->rows()->getComm(), squares(residual.history));
  const double target = std::max(settings_.tolerance * norm, round_off);
  bool descending = true;
  while (norm > target && report.iterations < settings_.iterations && descending) {
    if (age_ < 0 || age_ >= settings_.refresh) refresh_jacobian(x, residual.time);
    find_update(residual);
    descending = settings_.line_search ? searched_update(residual, x, f, norm, report)
                                       : full_update(residual, x, f, norm, report);
    ++report.iterations;
    if (!std::isfinite(norm)) {
      throw divergence(*model_, fmt::format("the residual is not finite after {} updates", report.iterations),
                       residual.time, x, f, residual_);
    }
    if (norm > divergence_growth * report.first_norm) {
      throw divergence(*model_,
                       fmt::format("the residual norm grew from {:.3g} to {:.3g} in {} updates; a growth by {:.0e} is "
                                   "taken as divergence",
                                   report.first_norm, norm, report.iterations, divergence_growth),
                       residual.time, x, f, residual_);
    }
  }
  report.last_norm = norm;
  report.converged = norm <= target;
  return report;
}

void FullOrder::refresh_jacobian(ConstVectorView x, double time) {
  const auto timer = timed("kiln: Jacobian");
  jacobian_->take(state_.sources(), time);
  Kokkos::deep_copy(frozen_x_, x);
  frozen_time_ = time;
  age_ = 0;
  ++jacobian_evaluations_;
}

void FullOrder::find_update(const StepResidual& residual) {
  const auto timer = timed("kiln: linear solve");
  const LinearSolveReport linear = jacobian_->solve(residual.alpha, residual.gamma, residual_, update_);
  linear_iterations_ += linear.iterations;
  if (!linear.converged) throw DivergenceError(linear.problem, residual.time);
}

bool FullOrder::full_update(const StepResidual& residual, VectorView x, VectorView f, double& norm,
                            SolveReport& report) {
  add_scaled(x, -1.0, update_, x);
  norm = norm_at(residual, x, f);
  ++report.residuals;
  return true;
}

bool FullOrder::searched_update(const StepResidual& residual, VectorView x, VectorView f, double& norm,
                                SolveReport& report) {
  const double start = norm;
  double length = 1.0;
  for (int halved = 0; halved <= NewtonSettings::halvings; ++halved, length /= 2) {
    add_scaled(x, -length, update_, trial_);
    norm = norm_at(residual, trial_, f);
    ++report.residuals;
    if (norm < start) break;
  }
  Kokkos::deep_copy(x, trial_);
  return norm < start;
}

NearestParticle FullOrder::nearest(const std::array<double, 3>& point) const {
  return nearest_particle(*particles(), positions(), point);
}

ConstPositionView FullOrder::positions() const {
  return Kokkos::subview(model_->positions(), std::make_pair(LocalIndex(0), local_size(*model_->rows())), Kokkos::ALL);
}

void FullOrder::state(ConstVectorView x, VectorView u) const { Kokkos::deep_copy(u, x); }

Method::Reader FullOrder::reader(const std::vector<LocalIndex>& places) const {
  const auto components = static_cast<LocalIndex>(model_->fields().size());
  const auto chosen = view_of<Kokkos::View<LocalIndex*, Device>>(places, "kiln::method::places");
  return [chosen, components](ConstVectorView x, VectorView u) {
    Kokkos::parallel_for(
        "kiln::method::read", RangePolicy(0, static_cast<LocalIndex>(chosen.extent(0))),
        KOKKOS_LAMBDA(const LocalIndex i) {
          for (LocalIndex c = 0; c < components; ++c) u(i * components + c) = x(chosen(i) * components + c);
        });
  };
}

void FullOrder::save(hdf5::Group& group) const {
  group.attribute("jacobian_age", static_cast<long long>(age_));
  if (age_ < 0) return;
  group.attribute("jacobian_time", frozen_time_);
  save_unknown(group, "jacobian_state", *halo_.rows(), frozen_x_);
}

void FullOrder::restore(const hdf5::Group& group) {
  const int age = static_cast<int>(group.integer("jacobian_age", -1, std::numeric_limits<int>::max()));
  if (age >= 0) {
    const VectorView x("kiln::method::restored state", halo_.row_size());
    restore_unknown(group, "jacobian_state", *halo_.rows(), x);
    Kokkos::deep_copy(state_.rows(), x);
    state_.fill();
    refresh_jacobian(x, group.finite_real("jacobian_time"));
  }
  age_ = age;
  resumed_ = true;
}

void FullOrder::report(nlohmann::json& section) const {
  section["particles"] = static_cast<long long>(model_->rows()->getGlobalNumElements());
  section["components"] = model_->fields().size();
  for (const auto& [name, value] : model_->facts()) section["model"][name] = value;
  section["jacobian"] = to_text(settings_.jacobian);
  section["refresh"] = settings_.refresh;
  section["tolerance"] = settings_.tolerance;
}

void FullOrder::report_work(nlohmann::json& section) const {
  section["jacobian_evaluations"] = jacobian_evaluations_;
  section["linear_iterations"] = linear_iterations_;
  section["finite_difference_rates"] = jacobian_->rate_evaluations();
  if (const auto* sums = dynamic_cast<const SumsOverRun*>(model_.get())) {
    for (const auto& [name, value] : sums->run_facts()) section["model"][name] = value;
  }
}

KILN_REGISTER(Method, FullOrder, "fom", "the full-order model: every particle's state is an unknown");

}  // namespace kiln
