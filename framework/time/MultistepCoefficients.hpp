#pragma once

#include <string>
#include <vector>

#include "framework/base/Error.hpp"

namespace kiln {

/// The coefficients α_j, β_j (j = 0 … k) of Eq. 14, Σ_j α_j u^{n−j} = Δt Σ_j β_j f(u^{n−j}, t^{n−j}).
struct MultistepCoefficients {
  std::vector<double> alpha;
  std::vector<double> beta;

  std::size_t steps() const { return alpha.size() - 1; }
  bool is_explicit() const { return beta[0] == 0.0; }
  /// Whether β_j ≠ 0 for some j ≥ 1: earlier rates are needed then.
  bool uses_earlier_rates() const;
  /// The largest p with Σ α_j (−j)^q = q Σ β_j (−j)^{q−1} for q = 0 … p, up to round-off: the order of accuracy.
  int order() const;

  /// What keeps the coefficients from being a convergent scheme, with paths relative to the block: lengths, α0 = 0,
  /// consistency (order ≥ 1), and zero-stability: roots of Σ α_j z^{k−j} lie in the closed unit disc, those on its rim
  /// are simple (Dahlquist 1956).
  std::vector<Problem> problems() const;

  static MultistepCoefficients backward_euler() { return {{1.0, -1.0}, {1.0, 0.0}}; }
  static MultistepCoefficients explicit_euler() { return {{1.0, -1.0}, {0.0, 1.0}}; }
  static MultistepCoefficients trapezoidal() { return {{1.0, -1.0}, {0.5, 0.5}}; }
  static MultistepCoefficients bdf2() { return {{1.5, -2.0, 0.5}, {1.0, 0.0, 0.0}}; }
};

}  // namespace kiln
