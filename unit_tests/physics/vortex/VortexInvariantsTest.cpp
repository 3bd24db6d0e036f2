#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "framework/base/Pi.hpp"
#include "unit_tests/framework/method/FullOrderCases.hpp"
#include "unit_tests/physics/vortex/VortexCase.hpp"

/// What vortices of any kernel conserve: Σ Γ x, Σ Γ y, Σ Γ |x|² and the Hamiltonian.
namespace kiln {
namespace {

/// −1/(4π) Σ_{i<j} Γ_i Γ_j Q(r²), dQ/ds = q(s).
double hamiltonian(const VortexCase& vortex_case, const VortexCloud& cloud, const std::vector<double>& places) {
  const double core = vortex_case.core_radius * vortex_case.core_radius;
  double sum = 0.0;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double s = std::pow(places[2 * i] - places[2 * j], 2) + std::pow(places[2 * i + 1] - places[2 * j + 1], 2);
      // −Ei(−z) is the exponential integral E1(z).
      const double potential =
          vortex_case.kernel == "lamb-oseen" ? std::log(s) - std::expint(-s / core) : std::log(s + core);
      sum += cloud.circulation[i] * cloud.circulation[j] * potential;
    }
  }
  return -sum / (4.0 * pi);
}

struct Invariants {
  std::array<double, 2> linear{};
  double angular = 0.0;
  double hamiltonian = 0.0;
};

Invariants invariants_of(const VortexCase& vortex_case, const std::vector<double>& places) {
  const VortexCloud cloud = vortex_case.cloud();
  Invariants result;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const double x = places[2 * i], y = places[2 * i + 1];
    result.linear[0] += cloud.circulation[i] * x;
    result.linear[1] += cloud.circulation[i] * y;
    result.angular += cloud.circulation[i] * (x * x + y * y);
  }
  result.hamiltonian = hamiltonian(vortex_case, cloud, places);
  return result;
}

/// Largest over the whole run.
struct Drift {
  double linear = 0.0;
  double angular = 0.0;
  double hamiltonian = 0.0;
  double moved = 0.0;  ///< displacement of a particle in m
};

Drift drift(const VortexCase& vortex_case, const std::string& type, int steps) {
  constexpr double end = 3.0;
  FullOrder method(std::shared_ptr<Model>(vortex_case.model()), newton(JacobianForm::matrix_free, 1e-13),
                   krylov("gmres", 1e-6));
  const std::vector<double> start = gathered(*method.particles(), initial(method));
  const Invariants before = invariants_of(vortex_case, start);
  const auto time_scheme = scheme(type, method, end / steps);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  Drift result;
  for (int n = 0; n < steps; ++n) {
    advance(*time_scheme, x, end / steps, n, n + 1);
    const std::vector<double> places = gathered(*method.particles(), x);
    const Invariants after = invariants_of(vortex_case, places);
    for (int axis = 0; axis < 2; ++axis) {
      result.linear = std::max(result.linear, std::abs(after.linear[axis] - before.linear[axis]));
    }
    result.angular = std::max(result.angular, std::abs(after.angular - before.angular));
    result.hamiltonian = std::max(result.hamiltonian, std::abs(after.hamiltonian - before.hamiltonian));
    for (std::size_t i = 0; i < places.size(); ++i) {
      result.moved = std::max(result.moved, std::abs(places[i] - start[i]));
    }
  }
  return result;
}

/// Halves the step and expects the drift of Σ Γ |x|² and of the Hamiltonian to fall with at least `order`, and Σ Γ x to
/// stay to round-off and the solver's tolerance.
void expect_conserved(const std::string& kernel, const std::string& type, int steps, double order) {
  VortexCase vortex_case;
  vortex_case.kernel = kernel;
  vortex_case.core_radius = 0.3;
  vortex_case.particles = VortexCase::two_patches(0.45);
  const Drift coarse = drift(vortex_case, type, steps), fine = drift(vortex_case, type, 2 * steps);
  const double angular = std::log2(coarse.angular / fine.angular);
  const double energy = std::log2(coarse.hamiltonian / fine.hamiltonian);
  if (world()->getRank() == 0) {
    std::printf("%-16s %-12s sum G|x|^2: %.2e, %.2e (order %.2f); Hamiltonian: %.2e, %.2e (order %.2f)\n",
                kernel.c_str(), type.c_str(), coarse.angular, fine.angular, angular, coarse.hamiltonian,
                fine.hamiltonian, energy);
  }
  EXPECT_GT(coarse.moved, 1.0) << "what hardly moves conserves everything";
  EXPECT_LT(coarse.linear, 2e-11);
  EXPECT_LT(fine.linear, 2e-11);
  EXPECT_GT(fine.hamiltonian, 1e-11) << "round-off shows no order";
  EXPECT_GT(fine.angular, 1e-11) << "round-off shows no order";
  EXPECT_GT(angular, order - 0.3);
  EXPECT_GT(energy, order - 0.3);
}

TEST(VortexInvariants, AreConservedAtTheOrderOfRungeKutta) {
  expect_conserved("rosenhead-moore", "rk4", 12, 4.0);
  expect_conserved("lamb-oseen", "rk4", 12, 4.0);
}

TEST(VortexInvariants, AreConservedAtTheOrderOfTheTrapezoidalRule) {
  expect_conserved("rosenhead-moore", "trapezoidal", 24, 2.0);
  expect_conserved("lamb-oseen", "trapezoidal", 24, 2.0);
}

TEST(VortexInvariants, CirculationIsWhatThePatchesSay) {
  const VortexCloud cloud = VortexCase().cloud();
  double sum = 0.0;
  for (const double circulation : cloud.circulation) sum += circulation;
  // Three radii out, exp(−9) of each patch is cut off.
  EXPECT_NEAR(sum, 0.8, 3.2 * 1.3e-4);
}

}  // namespace
}  // namespace kiln
