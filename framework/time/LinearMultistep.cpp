#include "framework/time/LinearMultistep.hpp"

#include <fmt/format.h>

#include <Teuchos_Array.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "framework/base/Error.hpp"
#include "framework/base/Loop.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Unknown.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

// Made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string add_level_label = "kiln::time::add a level to the history";

/// `first`: the history is overwritten.
void add_level(double alpha, const VectorView& u, bool first, const VectorView& history) {
  const auto level = borrowed(u);
  const auto sum = borrowed(history);
  loop(
      add_level_label, static_cast<LocalIndex>(history.extent(0)),
      KOKKOS_LAMBDA(const LocalIndex i) { sum(i) = (first ? 0.0 : sum(i)) + alpha * level(i); });
}

MultistepCoefficients starter_of(const MultistepCoefficients& scheme) {
  if (scheme.steps() == 1) return scheme;
  if (scheme.is_explicit()) return MultistepCoefficients::explicit_euler();
  return scheme.order() <= 2 ? MultistepCoefficients::backward_euler() : MultistepCoefficients::trapezoidal();
}

bool needs_runge_kutta_starter(const MultistepCoefficients& scheme) {
  return scheme.steps() > 1 && scheme.order() > (scheme.is_explicit() ? 2 : 3);
}

struct BackwardEuler : LinearMultistep {
  static Specification specification() { return {}; }
  BackwardEuler(const Teuchos::ParameterList&, const Context& context)
      : LinearMultistep(MultistepCoefficients::backward_euler(), context) {}
};

struct ExplicitEuler : LinearMultistep {
  static Specification specification() { return {}; }
  ExplicitEuler(const Teuchos::ParameterList&, const Context& context)
      : LinearMultistep(MultistepCoefficients::explicit_euler(), context) {}
};

struct Trapezoidal : LinearMultistep {
  static Specification specification() { return {}; }
  Trapezoidal(const Teuchos::ParameterList&, const Context& context)
      : LinearMultistep(MultistepCoefficients::trapezoidal(), context) {}
};

struct Bdf2 : LinearMultistep {
  static Specification specification() { return {}; }
  Bdf2(const Teuchos::ParameterList&, const Context& context)
      : LinearMultistep(MultistepCoefficients::bdf2(), context) {}
};

MultistepCoefficients coefficients_in(const Teuchos::ParameterList& list) {
  return {list.get<Teuchos::Array<double>>("alpha").toVector(), list.get<Teuchos::Array<double>>("beta").toVector()};
}

struct AnyLinearMultistep : LinearMultistep {
  static Specification specification() {
    Specification s;
    s.reals("alpha", "coefficients of the states, newest first (Eq. 14)");
    s.reals("beta", "coefficients of the rates, newest first; beta_0 = 0: explicit");
    s.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
      for (Problem& problem : coefficients_in(list).problems()) problems.push_back(std::move(problem));
    });
    return s;
  }
  AnyLinearMultistep(const Teuchos::ParameterList& list, const Context& context)
      : LinearMultistep(coefficients_in(list), context, list.name()) {}
};

KILN_REGISTER(TimeScheme, BackwardEuler, "backward euler", "implicit, order 1: the report's scheme");
KILN_REGISTER(TimeScheme, ExplicitEuler, "explicit euler", "explicit, order 1");
KILN_REGISTER(TimeScheme, Trapezoidal, "trapezoidal", "implicit, order 2, A-stable (Crank-Nicolson)");
KILN_REGISTER(TimeScheme, Bdf2, "bdf2", "backward differentiation, implicit, order 2, L-stable");
KILN_REGISTER(TimeScheme, AnyLinearMultistep, "linear multistep", "any coefficients alpha and beta of Eq. 14");

/// A form of the Jacobian that the model lacks, told at the key that asks for it.
void require_jacobian(Method& method) {
  try {
    method.require_jacobian();
  } catch (const NotOffered& error) {
    throw InputError("time.newton.jacobian", error.what());
  }
}

}  // namespace

LinearMultistep::LinearMultistep(MultistepCoefficients coefficients, const Context& context, const std::string& path)
    : coefficients_(std::move(coefficients)), method_(context.method), step_(context.step) {
  std::vector<Problem> problems = coefficients_.problems();
  for (Problem& problem : problems) problem.path = path.empty() ? problem.path : path + "." + problem.path;
  if (!problems.empty()) throw InputError(std::move(problems));
  if (!coefficients_.is_explicit()) require_jacobian(method_);
  starter_ = starter_of(coefficients_);
  if (needs_runge_kutta_starter(coefficients_)) {
    runge_kutta_starter_ = std::make_unique<RungeKuttaStep>(rk4_tableau(), method_, step_);
  }

  const LocalIndex unknowns = local_size(*method_.coordinates());
  for (std::size_t j = 0; j <= coefficients_.steps(); ++j) {
    levels_.push_back(std::make_unique<Level>());
    levels_[j]->x = VectorView("kiln::time::earlier unknown", unknowns);
  }
  allocate_rows();
}

void LinearMultistep::allocate_rows() {
  const LocalIndex rows = method_.row_size();
  if (static_cast<LocalIndex>(history_.extent(0)) == rows) return;
  const bool keep_rates = coefficients_.uses_earlier_rates() || starter_.uses_earlier_rates();
  for (const auto& level : levels_) {
    level->u = VectorView("kiln::time::earlier state", rows);
    level->f = keep_rates || level == levels_[0] ? VectorView("kiln::time::earlier rate", rows) : levels_[0]->f;
  }
  history_ = VectorView("kiln::time::history", rows);
}

void LinearMultistep::keep(Level& level, ConstVectorView x, double time) {
  Kokkos::deep_copy(level.x, x);
  level.time = time;
  method_.evaluate(x, time, level.u, level.f);
}

void LinearMultistep::start(ConstVectorView x, double time) {
  allocate_rows();
  keep(*levels_[0], x, time);
  known_ = 1;
}

void LinearMultistep::evaluate_anew() {
  allocate_rows();
  // Oldest first, as the run itself met them.
  for (std::size_t j = known_; j-- > 0;) {
    method_.evaluate(levels_[j]->x, levels_[j]->time, levels_[j]->u, levels_[j]->f);
  }
}

void LinearMultistep::gather_history(const MultistepCoefficients& scheme) {
  for (std::size_t j = 1; j <= scheme.steps(); ++j) {
    const Level& level = *levels_[j - 1];
    if (j == 1 || scheme.alpha[j] != 0.0) add_level(scheme.alpha[j], level.u, j == 1, history_);
    if (scheme.beta[j] != 0.0) add_level(-step_ * scheme.beta[j], level.f, false, history_);
  }
}

SolveReport LinearMultistep::advance(VectorView x, double time) {
  if (known_ == 0) throw std::logic_error("LinearMultistep::advance: neither started nor restored");
  if (method_.begin_step(time)) evaluate_anew();
  const bool starting = known_ < coefficients_.steps();
  Level& next = *levels_.back();
  SolveReport report;
  if (starting && runge_kutta_starter_) {
    report.residuals = runge_kutta_starter_->advance(x, levels_[0]->time) + 1;
    keep(next, x, time);
  } else {
    const MultistepCoefficients& scheme = starting ? starter_ : coefficients_;
    gather_history(scheme);
    report = method_.solve({scheme.alpha[0], step_ * scheme.beta[0], time, uncounted(history_)}, x, uncounted(next.u),
                           uncounted(next.f));
    copy_values(x, next.x);
    next.time = time;
  }
  // The oldest level is the one the next step writes.
  std::rotate(levels_.begin(), levels_.end() - 1, levels_.end());
  known_ = std::min(known_ + 1, coefficients_.steps());
  return report;
}

void LinearMultistep::save(hdf5::Group& group) const {
  std::vector<double> times;
  for (std::size_t j = 0; j < known_; ++j) {
    times.push_back(levels_[j]->time);
    save_unknown(group, fmt::format("unknown_{}", j), *method_.coordinates(), levels_[j]->x);
  }
  group.write("times", times);
}

void LinearMultistep::restore(const hdf5::Group& group) {
  const std::vector<double> times = group.finite_reals("times", {0}).values;
  if (times.empty() || times.size() > coefficients_.steps()) {
    throw FileError(group.file(), group.path() + "/times", fmt::format("there are {} earlier states", times.size()),
                    fmt::format("1 to {} of them for this time scheme", coefficients_.steps()));
  }
  known_ = times.size();
  allocate_rows();
  const VectorView x("kiln::time::restored unknown", levels_[0]->x.extent(0));
  // Oldest first, as the run itself met them.
  for (std::size_t j = known_; j-- > 0;) {
    restore_unknown(group, fmt::format("unknown_{}", j), *method_.coordinates(), x);
    keep(*levels_[j], x, times[j]);
  }
}

}  // namespace kiln
