#pragma once

#include <Kokkos_Core.hpp>
#include <cmath>

#include "framework/base/Lanes.hpp"

namespace kiln {

/// From here on 1 − e^{−z} rounds to 1.
inline constexpr double one_minus_exponential_is_one = 40.0;

/// 1 − e^{−z} of z ≥ 0, to a few units in the last place however small z is.
KOKKOS_FORCEINLINE_FUNCTION double one_minus_exponential(double z) { return -expm1(-z); }

#ifdef KILN_LANES
/// e^{−z} = 2^{−n} (1 + e) of eight numbers z between 0 and 708: n is the integer nearest to z/ln 2 and
/// e = e^r − 1 with r = n ln 2 − z.
struct ExponentialLanes {
  Lanes power;   ///< 2^{−n}
  Lanes excess;  ///< e

  KOKKOS_FORCEINLINE_FUNCTION explicit ExponentialLanes(const Lanes& z) {
    using Bits = long long __attribute__((vector_size(lane_count * sizeof(long long))));
    constexpr double one_over_log2 = 1.4426950408889634;
    // ln 2 in two parts, the first short enough for its product with n to be exact.
    constexpr double log2_high = 6.93147180369123816490e-01;
    constexpr double log2_low = 1.90821492927058770002e-10;
    // Adding 1.5 · 2^52 leaves the nearest integer in the low bits of the sum.
    constexpr double rounder = 6755399441055744.0;
    const Lanes shifted = z * one_over_log2 + rounder;
    const Lanes n = shifted - rounder;
    const Lanes r = (n * log2_high - z) + n * log2_low;
    Bits bits;
    __builtin_memcpy(&bits, &shifted, sizeof bits);
    bits = (1023LL << 52) - (bits << 52);
    __builtin_memcpy(&power, &bits, sizeof power);
    // Σ_{k=0}^{12} r^k/(k + 1)!, by pairs, which need not wait for each other: what is left out is below 2e-17 for
    // |r| ≤ ln 2/2.
    const Lanes r2 = r * r;
    const Lanes r4 = r2 * r2;
    const Lanes low = (1.0 + r * (1.0 / 2.0)) + r2 * (1.0 / 6.0 + r * (1.0 / 24.0));
    const Lanes middle = (1.0 / 120.0 + r * (1.0 / 720.0)) + r2 * (1.0 / 5040.0 + r * (1.0 / 40320.0));
    const Lanes high = (1.0 / 362880.0 + r * (1.0 / 3628800.0)) + r2 * (1.0 / 39916800.0 + r * (1.0 / 479001600.0));
    const Lanes g = low + r4 * (middle + r4 * (high + r4 * (1.0 / 6227020800.0)));
    excess = r * g;
  }
};

/// For n = 0, where it matters, nothing cancels.
inline Lanes one_minus_exponential(const Lanes& z) {
  constexpr double farthest = one_minus_exponential_is_one;
  const ExponentialLanes exponential(z < farthest ? z : all_lanes(farthest));
  return (1.0 - exponential.power) - exponential.power * exponential.excess;
}

/// e^{−z} of z ≥ 0, to a few units in the last place; 0 from 708 on, where it is below 4e-308.
inline Lanes decayed(const Lanes& z) {
  constexpr double farthest = 708.0;
  const ExponentialLanes exponential(z < farthest ? z : all_lanes(farthest));
  const Lanes value = exponential.power + exponential.power * exponential.excess;
  return z < farthest ? value : all_lanes(0.0);
}
#endif

}  // namespace kiln
