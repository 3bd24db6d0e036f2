#pragma once

#include <string>
#include <vector>

namespace kiln {

/// An explicit Runge–Kutta method: stage i evaluates k_i = f(u + Δt Σ_{j<i} a_ij k_j, t + c_i Δt), and
/// u^n = u^{n−1} + Δt Σ b_i k_i.
struct ButcherTableau {
  std::vector<std::vector<double>> a;  ///< row i has i entries
  std::vector<double> b;
  std::vector<double> c;

  std::size_t stages() const { return b.size(); }
};

/// The classical method of order 4.
inline ButcherTableau rk4_tableau() {
  return {{{}, {0.5}, {0.0, 0.5}, {0.0, 0.0, 1.0}}, {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, {0.0, 0.5, 0.5, 1.0}};
}

/// Shu and Osher (1988), order 3, strong-stability preserving.
inline ButcherTableau ssp_rk3_tableau() {
  return {{{}, {1.0}, {0.25, 0.25}}, {1.0 / 6, 1.0 / 6, 2.0 / 3}, {0.0, 1.0, 0.5}};
}

/// Heun's method of order 2, the explicit trapezoidal rule.
inline ButcherTableau heun_tableau() { return {{{}, {1.0}}, {0.5, 0.5}, {0.0, 1.0}}; }

}  // namespace kiln
