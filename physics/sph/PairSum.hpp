#pragma once

#include <Kokkos_Core.hpp>

#include "physics/sph/Lanes.hpp"
#include "physics/sph/ThermalState.hpp"

/// The one place where the pair term of Eq. 11 is written; HeatJacobian.cpp has its derivatives. Written for any scalar
/// type, so that automatic differentiation (Sacado) and complex steps go through the very code that runs, and for
/// Lanes.
namespace kiln {

/// What is summed over the neighbours j of a particle i, w = r_ij·∇W_ij / r_ij² in 1/m⁵: a quarter of a term of Eq. 7's
/// sum, and its derivative by u_i with the properties held.
enum class PairQuantity {
  flux,        ///< w V_j (u_i − u_j)/(1/k_i + 1/k_j) in W/m³
  conductance  ///< w V_j/(1/k_i + 1/k_j) in W/(m³ K)
};

/// A pair's term, or several terms' sum, before its division. Fractions add without dividing, so that several pairs
/// share one divide, the slowest instruction of all; the product of eight denominators 1/k_i + 1/k_j stays far inside
/// the range of double for any conductivity between 1e-30 and 1e30 W/(m K).
template <class Scalar>
struct PairTerm {
  Scalar numerator;
  Scalar denominator;

  KOKKOS_FORCEINLINE_FUNCTION Scalar value() const { return numerator / denominator; }
  template <class Weight>
  KOKKOS_FORCEINLINE_FUNCTION PairTerm weighted(const Weight& weight) const {
    return {weight * numerator, denominator};
  }
};

template <class Scalar>
KOKKOS_FORCEINLINE_FUNCTION PairTerm<Scalar> operator+(const PairTerm<Scalar>& a, const PairTerm<Scalar>& b) {
  return {a.numerator * b.denominator + b.numerator * a.denominator, a.denominator * b.denominator};
}

/// The term without its weight.
template <PairQuantity quantity, class Scalar>
KOKKOS_FORCEINLINE_FUNCTION PairTerm<Scalar> pair_term(const Scalar& u_i, const Scalar& resistivity_i,
                                                       const Scalar& u_j, const Scalar& resistivity_j,
                                                       const Scalar& volume_j) {
  if constexpr (quantity == PairQuantity::flux) {
    return {volume_j * (u_i - u_j), resistivity_i + resistivity_j};
  } else {
    return {volume_j, resistivity_i + resistivity_j};
  }
}

/// Sum over a row's pairs, in their order.
template <PairQuantity quantity = PairQuantity::flux, class Scalar>
KOKKOS_INLINE_FUNCTION Scalar pair_sum(const ThermalState<Scalar>* states, const ThermalState<Scalar>& i,
                                       const LocalIndex* sources, const double* weights, LocalIndex count) {
  Scalar sum = 0.0;
  for (LocalIndex pair = 0; pair < count; ++pair) {
    const ThermalState<Scalar>& j = states[sources[pair]];
    sum += weights[pair] *
           pair_term<quantity>(i.temperature, i.resistivity, j.temperature, j.resistivity, j.volume).value();
  }
  return sum;
}

#ifdef KILN_LANES
/// Pairs that share one divide in the sums below.
inline constexpr LocalIndex pairs_that_share = 4;

/// Σ of term(0) … term(count − 1), in their order.
template <class Term>
inline Lanes sum_of_terms(LocalIndex count, const Term& term) {
  Lanes sum = {};
  LocalIndex pair = 0;
  for (; pair + pairs_that_share <= count; pair += pairs_that_share) {
    sum += ((term(pair) + term(pair + 1)) + (term(pair + 2) + term(pair + 3))).value();
  }
  for (; pair < count; ++pair) sum += term(pair).value();
  return sum;
}

/// pair_sum of eight rows i, a lane each. sources, weights: pair by pair, row by row. Where `count` is a multiple of
/// pairs_that_share, pairs of no weight behind a row's own ones do not change a bit of its sum.
template <PairQuantity quantity>
inline Lanes pair_sum_of_rows(const ThermalState<double>* states, const StateLanes& i, const LocalIndex* sources,
                              const double* weights, LocalIndex count) {
  return sum_of_terms(count, [&](LocalIndex pair) {
    // The hardware's own prefetching stops at each 4 KiB page of these two streams: a third of the time.
    __builtin_prefetch(weights + pair * lane_count + 512);
    __builtin_prefetch(sources + pair * lane_count + 1024);
    const StateLanes j = state_lanes(states, sources + pair * lane_count);
    return pair_term<quantity>(i.temperature, i.resistivity, j.temperature, j.resistivity, j.volume)
        .weighted(lanes_at(weights + pair * lane_count));
  });
}

/// pair_sum of PairQuantity::flux of a row in eight states at once, the lanes.
inline Lanes pair_sum_of_points(const StateLanes* states, const StateLanes& i, const LocalIndex* sources,
                                const double* weights, LocalIndex count) {
  return sum_of_terms(count, [&](LocalIndex pair) {
    const StateLanes& j = states[sources[pair]];
    return pair_term<PairQuantity::flux>(i.temperature, i.resistivity, j.temperature, j.resistivity, j.volume)
        .weighted(weights[pair]);
  });
}
#endif

/// f_i of Eq. 11 in K/s from Σ_j of PairQuantity::flux. With V_j = m_j/ρ_j and 4 k_i k_j/(k_i + k_j) = 4/(1/k_i +
/// 1/k_j) it is the power that reaches the particle, 4 V_i Σ_j (…) + q_i A_i, over its heat capacity m_i c_i.
template <class Scalar>
KOKKOS_INLINE_FUNCTION Scalar heat_rate(const Scalar& volume, const Scalar& specific_heat, const Scalar& sum,
                                        double mass, const Scalar& absorbed_power) {
  return (4.0 * volume * sum + absorbed_power) / (mass * specific_heat);
}
template <class Scalar>
KOKKOS_INLINE_FUNCTION Scalar heat_rate(const ThermalState<Scalar>& i, const Scalar& sum, double mass,
                                        double absorbed_power) {
  return heat_rate(i.volume, i.specific_heat, sum, mass, Scalar(absorbed_power));
}

}  // namespace kiln
