#pragma once

#include <Kokkos_Core.hpp>
#include <type_traits>

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/MaterialTable.hpp"

/// The one place where the pairs of Eq. 11 are summed. Written for any scalar type, so that automatic differentiation
/// (Sacado) and complex steps go through the very code that runs.
namespace kiln {

/// What the pair sum reads of one source, in one piece of memory.
template <class Scalar>
struct alignas(32) ThermalState {
  Scalar temperature;    ///< u in K
  Scalar resistivity;    ///< 1/k in m K/W
  Scalar volume;         ///< V = m/ρ(u) in m³
  Scalar specific_heat;  ///< c in J/(kg K)
};

template <class Scalar>
KOKKOS_INLINE_FUNCTION ThermalState<Scalar> thermal_state(const MaterialTable& table, const Scalar& temperature,
                                                          double mass) {
  const MaterialPoint<Scalar> point = table.at(temperature);
  return {temperature, 1.0 / point.conductivity, mass / point.density, point.specific_heat};
}

/// Adds w V_j (u_i − u_j) / (1/k_i + 1/k_j) to `sum`, a quarter of a term of Eq. 7's sum with w = r_ij·∇W_ij / r_ij² in
/// 1/m⁵. Also takes several pairs at once, as vectors of GCC and Clang.
template <class Weight, class Scalar>
KOKKOS_FORCEINLINE_FUNCTION void add_pair(Scalar& sum, const Weight& weight, const Scalar& u_i,
                                          const Scalar& resistivity_i, const Scalar& u_j, const Scalar& resistivity_j,
                                          const Scalar& volume_j) {
  sum += weight * volume_j * (u_i - u_j) / (resistivity_i + resistivity_j);
}

#if defined(__GNUC__) && !defined(__CUDA_ARCH__) && !defined(__HIP_DEVICE_COMPILE__)
#define KILN_PAIR_LANES
using PairLanes = double __attribute__((vector_size(32)));
static_assert(sizeof(ThermalState<double>) == sizeof(PairLanes));

/// Sum of add_pair over pairs [0, count / 4 · 4). Whole states are loaded and transposed in registers: two thirds of
/// the time of gathering field by field, which is what compilers make of the plain loop.
inline double pair_lanes(const ThermalState<double>* states, const ThermalState<double>& i, const LocalIndex* sources,
                         const double* weights, LocalIndex count) {
  const PairLanes u_i = {i.temperature, i.temperature, i.temperature, i.temperature};
  const PairLanes resistivity_i = {i.resistivity, i.resistivity, i.resistivity, i.resistivity};
  PairLanes sum = {0.0, 0.0, 0.0, 0.0};
  for (LocalIndex pair = 0; pair + 4 <= count; pair += 4) {
    // The hardware's own prefetching stops at each 4 KiB page of these two streams: a third of the time.
    __builtin_prefetch(weights + pair + 512);
    __builtin_prefetch(sources + pair + 1024);
    PairLanes s0, s1, s2, s3, weight;
    __builtin_memcpy(&s0, &states[sources[pair]], sizeof s0);
    __builtin_memcpy(&s1, &states[sources[pair + 1]], sizeof s1);
    __builtin_memcpy(&s2, &states[sources[pair + 2]], sizeof s2);
    __builtin_memcpy(&s3, &states[sources[pair + 3]], sizeof s3);
    __builtin_memcpy(&weight, weights + pair, sizeof weight);
    const PairLanes even01 = __builtin_shufflevector(s0, s1, 0, 4, 2, 6);
    const PairLanes even23 = __builtin_shufflevector(s2, s3, 0, 4, 2, 6);
    const PairLanes odd01 = __builtin_shufflevector(s0, s1, 1, 5, 3, 7);
    const PairLanes odd23 = __builtin_shufflevector(s2, s3, 1, 5, 3, 7);
    const PairLanes u_j = __builtin_shufflevector(even01, even23, 0, 1, 4, 5);
    const PairLanes volume_j = __builtin_shufflevector(even01, even23, 2, 3, 6, 7);
    const PairLanes resistivity_j = __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5);
    add_pair(sum, weight, u_i, resistivity_i, u_j, resistivity_j, volume_j);
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}
#endif

/// Σ_j of add_pair over a row's pairs, in their order up to lanes: the same bits wherever the row lives.
template <class Scalar>
KOKKOS_INLINE_FUNCTION Scalar pair_sum(const ThermalState<Scalar>* states, const ThermalState<Scalar>& i,
                                       const LocalIndex* sources, const double* weights, LocalIndex count) {
  Scalar sum = 0.0;
  LocalIndex pair = 0;
#ifdef KILN_PAIR_LANES
  if constexpr (std::is_same_v<Scalar, double>) {
    sum = pair_lanes(states, i, sources, weights, count);
    pair = count - count % 4;
  }
#endif
  for (; pair < count; ++pair) {
    const ThermalState<Scalar>& j = states[sources[pair]];
    add_pair(sum, weights[pair], i.temperature, i.resistivity, j.temperature, j.resistivity, j.volume);
  }
  return sum;
}

/// f_i of Eq. 11 in K/s. With V_j = m_j/ρ_j and 4 k_i k_j/(k_i + k_j) = 4/(1/k_i + 1/k_j) it is the power that reaches
/// the particle, 4 V_i Σ_j (…) + q_i A_i, over its heat capacity m_i c_i.
template <class Scalar>
KOKKOS_INLINE_FUNCTION Scalar heat_rate(const ThermalState<Scalar>* states, LocalIndex row, const LocalIndex* sources,
                                        const double* weights, LocalIndex count, double mass, double absorbed_power) {
  const ThermalState<Scalar>& i = states[row];
  return (4.0 * i.volume * pair_sum(states, i, sources, weights, count) + absorbed_power) / (mass * i.specific_heat);
}

}  // namespace kiln
