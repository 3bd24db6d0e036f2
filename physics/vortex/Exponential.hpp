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
/// The same for eight numbers, each below 2^51: with n the integer nearest to z/ln 2 and r = n ln 2 − z, it is
/// (1 − 2^{−n}) − 2^{−n} r g(r), g(r) = (e^r − 1)/r, and for n = 0 nothing cancels.
inline Lanes one_minus_exponential(const Lanes& z) {
  using Bits = long long __attribute__((vector_size(lane_count * sizeof(long long))));
  constexpr double one_over_log2 = 1.4426950408889634;
  // ln 2 in two parts, the first short enough for its product with n to be exact.
  constexpr double log2_high = 6.93147180369123816490e-01;
  constexpr double log2_low = 1.90821492927058770002e-10;
  // Adding 1.5 · 2^52 leaves the nearest integer in the low bits of the sum.
  constexpr double rounder = 6755399441055744.0;
  constexpr double farthest = one_minus_exponential_is_one;
  const Lanes w = z < farthest ? z : all_lanes(farthest);
  const Lanes shifted = w * one_over_log2 + rounder;
  const Lanes n = shifted - rounder;
  const Lanes r = (n * log2_high - w) + n * log2_low;
  Bits bits;
  __builtin_memcpy(&bits, &shifted, sizeof bits);
  bits = (1023LL << 52) - (bits << 52);
  Lanes power;  // 2^{−n}
  __builtin_memcpy(&power, &bits, sizeof power);
  // Σ_{k=0}^{12} r^k/(k + 1)!: what is left out is below 2e-17 for |r| ≤ ln 2/2.
  Lanes g = all_lanes(1.0 / 6227020800.0);
  g = g * r + 1.0 / 479001600.0;
  g = g * r + 1.0 / 39916800.0;
  g = g * r + 1.0 / 3628800.0;
  g = g * r + 1.0 / 362880.0;
  g = g * r + 1.0 / 40320.0;
  g = g * r + 1.0 / 5040.0;
  g = g * r + 1.0 / 720.0;
  g = g * r + 1.0 / 120.0;
  g = g * r + 1.0 / 24.0;
  g = g * r + 1.0 / 6.0;
  g = g * r + 0.5;
  g = g * r + 1.0;
  return (1.0 - power) - power * (r * g);
}
#endif

}  // namespace kiln
