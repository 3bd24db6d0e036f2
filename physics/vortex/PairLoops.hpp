#pragma once

#include <Kokkos_Core.hpp>
#include <type_traits>

#include "physics/vortex/KernelLaws.hpp"
#include "physics/vortex/VortexKernel.hpp"

/// The innermost loops over pairs of vortices, for any law of KernelLaws.hpp. `Scalar` is Lanes, eight vortices at
/// once, or double, one after the other.
namespace kiln {

#ifdef KILN_LANES
using VortexScalar = Lanes;
#else
using VortexScalar = double;
#endif

template <class Scalar>
inline constexpr LocalIndex vortex_lanes = static_cast<LocalIndex>(sizeof(Scalar) / sizeof(double));

/// What the vortices of VortexArrays and VortexLists are padded to.
inline constexpr LocalIndex vortex_multiple = vortex_lanes<VortexScalar>;

template <class Scalar>
struct VortexPoints {
  Scalar x;
  Scalar y;
};

namespace pair_loops {

KOKKOS_FORCEINLINE_FUNCTION double total(double x) { return x; }
KOKKOS_FORCEINLINE_FUNCTION double least(double x) { return x; }

template <class Scalar>
KOKKOS_FORCEINLINE_FUNCTION Scalar load(const double* numbers) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return *numbers;
  } else {
    return lanes_at(numbers);
  }
}

template <class Scalar>
KOKKOS_FORCEINLINE_FUNCTION Scalar spread(double number) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return number;
  } else {
    return all_lanes(number);
  }
}

#ifdef KILN_LANES
inline double total(const Lanes& x) { return lane_sum(x); }

/// Smallest of the lanes; what is not a number may or may not count.
inline double least(const Lanes& x) {
  const HalfLanes lower = __builtin_shufflevector(x, x, 0, 1, 2, 3);
  const HalfLanes upper = __builtin_shufflevector(x, x, 4, 5, 6, 7);
  const HalfLanes four = lower < upper ? lower : upper;
  const HalfLanes swapped = __builtin_shufflevector(four, four, 2, 3, 0, 1);
  const HalfLanes two = four < swapped ? four : swapped;
  return two[0] < two[1] ? two[0] : two[1];
}

/// Eight points, x and y apart. Whole points are loaded and transposed in registers, which takes half the instructions
/// of gathering x and y one by one.
inline VortexPoints<Lanes> gathered_lanes(const double* points, const LocalIndex* offsets) {
  using Pair = double __attribute__((vector_size(2 * sizeof(double))));
  Pair p[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) __builtin_memcpy(&p[lane], points + offsets[lane], sizeof(Pair));
  // Points 0, 2, 4, 6 and points 1, 3, 5, 7: x and y then part without crossing quarters.
  const HalfLanes p02 = __builtin_shufflevector(p[0], p[2], 0, 1, 2, 3);
  const HalfLanes p46 = __builtin_shufflevector(p[4], p[6], 0, 1, 2, 3);
  const HalfLanes p13 = __builtin_shufflevector(p[1], p[3], 0, 1, 2, 3);
  const HalfLanes p57 = __builtin_shufflevector(p[5], p[7], 0, 1, 2, 3);
  const Lanes even = __builtin_shufflevector(p02, p46, 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes odd = __builtin_shufflevector(p13, p57, 0, 1, 2, 3, 4, 5, 6, 7);
  return {__builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14),
          __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15)};
}
#endif

template <class Scalar>
KOKKOS_FORCEINLINE_FUNCTION VortexPoints<Scalar> gathered(const double* points, const LocalIndex* offsets) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return {points[*offsets], points[*offsets + 1]};
  } else {
    return gathered_lanes(points, offsets);
  }
}

}  // namespace pair_loops

/// numerator/d of four denominators by one divide and nine products.
template <class Scalar>
KOKKOS_FORCEINLINE_FUNCTION void share_divide(const Scalar& numerator, const Scalar (&d)[4], Scalar (&quotient)[4]) {
  const Scalar d01 = d[0] * d[1];
  const Scalar d23 = d[2] * d[3];
  const Scalar all = numerator / (d01 * d23);
  const Scalar over01 = all * d23;
  const Scalar over23 = all * d01;
  quotient[0] = over01 * d[1];
  quotient[1] = over01 * d[0];
  quotient[2] = over23 * d[3];
  quotient[3] = over23 * d[2];
}

/// The law's fractions for s = r² + offset of four pairs, or lanes of pairs. Away from every vortex's core they are
/// 1/s, which is most of them and spares the exponentials.
template <class Scalar, class Law>
KOKKOS_FORCEINLINE_FUNCTION void four_fractions(const Law& law, const Scalar (&s)[4], Scalar (&numerator)[4],
                                                Scalar (&denominator)[4]) {
  if constexpr (Law::has_near_field) {
    const Scalar a = s[0] < s[1] ? s[0] : s[1];
    const Scalar b = s[2] < s[3] ? s[2] : s[3];
    if (pair_loops::least(Scalar(a < b ? a : b)) >= law.near_field()) {
      for (int k = 0; k < 4; ++k) {
        numerator[k] = Scalar{} + 1.0;
        denominator[k] = s[k];
      }
      return;
    }
  }
  for (int k = 0; k < 4; ++k) {
    const KernelFraction<Scalar> q = law.fraction(s[k]);
    numerator[k] = q.numerator;
    denominator[k] = q.denominator;
  }
}

/// Σ_j Γ_j q r⊥ at four targets, which share the loads of the vortices and, for each vortex, one divide.
template <class Scalar, class Law>
KOKKOS_INLINE_FUNCTION void sum_at_four(const Law& law, const VortexArrays& vortices, const double (&targets)[8],
                                        double (&sums)[8]) {
  using namespace pair_loops;
  Scalar x[4], y[4], u[4] = {}, v[4] = {};
  for (int t = 0; t < 4; ++t) {
    x[t] = spread<Scalar>(targets[2 * t]);
    y[t] = spread<Scalar>(targets[2 * t + 1]);
  }
  const double offset = law.offset();
  for (LocalIndex j = 0; j < vortices.padded; j += vortex_lanes<Scalar>) {
    const Scalar xj = load<Scalar>(vortices.x + j);
    const Scalar yj = load<Scalar>(vortices.y + j);
    Scalar dx[4], dy[4], s[4], numerator[4], denominator[4], quotient[4];
    for (int t = 0; t < 4; ++t) {
      dx[t] = x[t] - xj;
      dy[t] = y[t] - yj;
      s[t] = dx[t] * dx[t] + (dy[t] * dy[t] + offset);
    }
    four_fractions(law, s, numerator, denominator);
    share_divide(load<Scalar>(vortices.circulation + j), denominator, quotient);
    for (int t = 0; t < 4; ++t) {
      const Scalar weight = quotient[t] * numerator[t];
      u[t] -= weight * dy[t];
      v[t] += weight * dx[t];
    }
  }
  for (int t = 0; t < 4; ++t) {
    sums[2 * t] = total(u[t]);
    sums[2 * t + 1] = total(v[t]);
  }
}

/// Σ_j Γ_j q r⊥ at one target over its list of `count` vortices; four groups of lanes share a divide.
template <class Scalar, class Law>
KOKKOS_INLINE_FUNCTION void sum_over_list(const Law& law, const double* points, const LocalIndex* sources,
                                          const double* circulations, LocalIndex count, double x, double y,
                                          double (&sum)[2]) {
  using namespace pair_loops;
  constexpr LocalIndex step = vortex_lanes<Scalar>;
  const Scalar xi = spread<Scalar>(x);
  const Scalar yi = spread<Scalar>(y);
  const double offset = law.offset();
  Scalar u = {}, v = {};
  LocalIndex p = 0;
  for (; p + 4 * step <= count; p += 4 * step) {
    Scalar dx[4], dy[4], s[4], numerator[4], denominator[4], quotient[4];
    for (int g = 0; g < 4; ++g) {
      const VortexPoints<Scalar> j = gathered<Scalar>(points, sources + p + g * step);
      dx[g] = xi - j.x;
      dy[g] = yi - j.y;
      s[g] = dx[g] * dx[g] + (dy[g] * dy[g] + offset);
    }
    four_fractions(law, s, numerator, denominator);
    share_divide(spread<Scalar>(1.0), denominator, quotient);
    for (int g = 0; g < 4; ++g) {
      const Scalar weight = quotient[g] * (numerator[g] * load<Scalar>(circulations + p + g * step));
      u -= weight * dy[g];
      v += weight * dx[g];
    }
  }
  for (; p < count; p += step) {
    const VortexPoints<Scalar> j = gathered<Scalar>(points, sources + p);
    const Scalar dx = xi - j.x;
    const Scalar dy = yi - j.y;
    const KernelFraction<Scalar> q = law.fraction(Scalar(dx * dx + (dy * dy + offset)));
    const Scalar weight = load<Scalar>(circulations + p) * q.numerator / q.denominator;
    u -= weight * dy;
    v += weight * dx;
  }
  sum[0] = total(u);
  sum[1] = total(v);
}

/// The vortices of VortexArrays with some columns of their tangents, as the loops below read them.
struct ArrayReader {
  VortexArrays vortices;
  TangentArrays tangents;  ///< from the first column read

  KOKKOS_FORCEINLINE_FUNCTION LocalIndex count() const { return vortices.padded; }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION VortexPoints<Scalar> point(LocalIndex p) const {
    return {pair_loops::load<Scalar>(vortices.x + p), pair_loops::load<Scalar>(vortices.y + p)};
  }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION Scalar circulation(LocalIndex p) const {
    return pair_loops::load<Scalar>(vortices.circulation + p);
  }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION VortexPoints<Scalar> tangent(int column, LocalIndex p) const {
    const std::size_t at = column * tangents.stride + p;
    return {pair_loops::load<Scalar>(tangents.x + at), pair_loops::load<Scalar>(tangents.y + at)};
  }
};

/// The vortices of one list of VortexLists, likewise.
struct ListReader {
  const double* points;
  const LocalIndex* sources;
  const double* circulations;
  LocalIndex number;
  Tangents<const double> tangents;  ///< from the first column read

  KOKKOS_FORCEINLINE_FUNCTION LocalIndex count() const { return number; }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION VortexPoints<Scalar> point(LocalIndex p) const {
    return pair_loops::gathered<Scalar>(points, sources + p);
  }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION Scalar circulation(LocalIndex p) const {
    return pair_loops::load<Scalar>(circulations + p);
  }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION VortexPoints<Scalar> tangent(int column, LocalIndex p) const {
    return pair_loops::gathered<Scalar>(tangents.values + column * tangents.stride, sources + p);
  }
};

/// Σ_j Γ_j 2 q′ Δx Δy at one target: −∂u/∂x and ∂v/∂y.
template <class Scalar, class Law, class Reader>
KOKKOS_INLINE_FUNCTION double shear_at(const Law& law, const Reader& vortices, double x, double y) {
  using namespace pair_loops;
  const Scalar xi = spread<Scalar>(x);
  const Scalar yi = spread<Scalar>(y);
  Scalar sum = {};
  for (LocalIndex p = 0; p < vortices.count(); p += vortex_lanes<Scalar>) {
    const VortexPoints<Scalar> j = vortices.template point<Scalar>(p);
    const Scalar dx = xi - j.x;
    const Scalar dy = yi - j.y;
    const KernelSlope<Scalar> q = law.slope(Scalar(dx * dx + (dy * dy + law.offset())));
    sum += vortices.template circulation<Scalar>(p) * q.slope * (dx * dy);
  }
  return 2.0 * total(sum);
}

/// Σ_j Γ_j D(q r⊥)(v_i − v_j) at one target for `Width` columns. own: x and y of v_i, column by column; sums likewise.
template <class Scalar, int Width, class Law, class Reader>
KOKKOS_INLINE_FUNCTION void tangents_at(const Law& law, const Reader& vortices, double x, double y,
                                        const double (&own)[2 * Width], double (&sums)[2 * Width]) {
  using namespace pair_loops;
  const Scalar xi = spread<Scalar>(x);
  const Scalar yi = spread<Scalar>(y);
  Scalar u[Width] = {}, v[Width] = {};
  for (LocalIndex p = 0; p < vortices.count(); p += vortex_lanes<Scalar>) {
    const VortexPoints<Scalar> j = vortices.template point<Scalar>(p);
    const Scalar circulation = vortices.template circulation<Scalar>(p);
    const Scalar dx = xi - j.x;
    const Scalar dy = yi - j.y;
    const KernelSlope<Scalar> q = law.slope(Scalar(dx * dx + (dy * dy + law.offset())));
    const Scalar twice = 2.0 * circulation * q.slope;
    const Scalar value = circulation * q.value;
    const Scalar mixed = twice * dx * dy;
    const Scalar along_y = value + twice * dy * dy;
    const Scalar along_x = value + twice * dx * dx;
    for (int c = 0; c < Width; ++c) {
      const VortexPoints<Scalar> vj = vortices.template tangent<Scalar>(c, p);
      const Scalar ex = own[2 * c] - vj.x;
      const Scalar ey = own[2 * c + 1] - vj.y;
      u[c] -= mixed * ex + along_y * ey;
      v[c] += along_x * ex + mixed * ey;
    }
  }
  for (int c = 0; c < Width; ++c) {
    sums[2 * c] = total(u[c]);
    sums[2 * c + 1] = total(v[c]);
  }
}

}  // namespace kiln
