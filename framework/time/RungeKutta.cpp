#include "framework/time/RungeKutta.hpp"

#include <Tpetra_Map.hpp>
#include <utility>

#include "framework/files/Hdf5.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

void add_scaled(double scale, const ConstVectorView& direction, const VectorView& x) {
  Kokkos::parallel_for(
      "kiln::time::add_slope", RangePolicy(0, static_cast<LocalIndex>(x.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { x(i) += scale * direction(i); });
}

struct Rk4 : RungeKutta {
  static Specification specification() { return {}; }
  Rk4(const Teuchos::ParameterList&, const Context& context) : RungeKutta(rk4_tableau(), context) {}
};

struct SspRk3 : RungeKutta {
  static Specification specification() { return {}; }
  SspRk3(const Teuchos::ParameterList&, const Context& context) : RungeKutta(ssp_rk3_tableau(), context) {}
};

struct Heun : RungeKutta {
  static Specification specification() { return {}; }
  Heun(const Teuchos::ParameterList&, const Context& context) : RungeKutta(heun_tableau(), context) {}
};

KILN_REGISTER(TimeScheme, Rk4, "rk4", "classical Runge-Kutta, explicit, order 4");
KILN_REGISTER(TimeScheme, SspRk3, "ssp rk3", "strong-stability-preserving Runge-Kutta, explicit, order 3");
KILN_REGISTER(TimeScheme, Heun, "heun", "Heun's method, explicit, order 2");

}  // namespace

RungeKuttaStep::RungeKuttaStep(ButcherTableau tableau, Method& method, double step)
    : tableau_(std::move(tableau)), method_(method), step_(step) {
  const LocalIndex size = local_size(*method.coordinates());
  stage_ = VectorView("kiln::time::stage", size);
  for (std::size_t i = 0; i < tableau_.stages(); ++i) slopes_.emplace_back("kiln::time::slope", size);
}

int RungeKuttaStep::advance(VectorView x, double time) {
  int evaluations = 0;
  for (std::size_t i = 0; i < tableau_.stages(); ++i) {
    Kokkos::deep_copy(stage_, x);
    for (std::size_t j = 0; j < i; ++j) {
      if (tableau_.a[i][j] != 0.0) add_scaled(step_ * tableau_.a[i][j], slopes_[j], stage_);
    }
    evaluations += method_.rate(stage_, time + tableau_.c[i] * step_, slopes_[i]);
  }
  for (std::size_t i = 0; i < tableau_.stages(); ++i) add_scaled(step_ * tableau_.b[i], slopes_[i], x);
  return evaluations;
}

RungeKutta::RungeKutta(ButcherTableau tableau, const Context& context)
    : method_(context.method), step_(std::move(tableau), context.method, context.step) {}

void RungeKutta::start(ConstVectorView, double time) { time_ = time; }

SolveReport RungeKutta::advance(VectorView x, double time) {
  SolveReport report;
  method_.begin_step(time);
  report.residuals = step_.advance(x, time_);
  time_ = time;
  return report;
}

void RungeKutta::save(hdf5::Group& group) const { group.attribute("time", time_); }

void RungeKutta::restore(const hdf5::Group& group) { time_ = group.finite_real("time"); }

}  // namespace kiln
