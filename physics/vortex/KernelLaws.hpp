#pragma once

#include <Kokkos_Core.hpp>

#include "framework/base/Exponential.hpp"

/// The regularised Biot–Savart kernels K(r) = q(|r|²) r⊥/(2π), r⊥ = (−y, x), written for numbers and for Lanes. A law
/// of one's own has the functions of RosenheadMooreLaw and becomes a component by VortexKernelOf.
namespace kiln {

/// q before its division: several pairs share one divide, the slowest instruction of all.
template <class Scalar>
struct KernelFraction {
  Scalar numerator;
  Scalar denominator;
};

/// q in 1/m² and dq/d(r²) in 1/m⁴.
template <class Scalar>
struct KernelSlope {
  Scalar value;
  Scalar slope;
};

/// q = 1/(r² + δ²): L. Rosenhead, Proc. R. Soc. A 127 (1930) 590; D. W. Moore (1972).
class RosenheadMooreLaw {
 public:
  /// Whether q is 1/s, s = r² + offset(), only where s reaches near_field().
  static constexpr bool has_near_field = false;

  /// δ in m, above 0.
  explicit RosenheadMooreLaw(double core_radius) : offset_(core_radius * core_radius) {}

  /// In m²; the functions below take s = r² + offset(), which costs no instruction of its own.
  KOKKOS_FORCEINLINE_FUNCTION double offset() const { return offset_; }
  /// Denominators of four pairs are multiplied: distances and cores between 1e-35 m and 1e35 m stay inside double.
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION KernelFraction<Scalar> fraction(const Scalar& s) const {
    return {Scalar{} + 1.0, s};
  }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION KernelSlope<Scalar> slope(const Scalar& s) const {
    const Scalar value = 1.0 / s;
    return {value, -value * value};
  }

 private:
  double offset_;
};

/// q = (1 − exp(−r²/δ²))/r², the field of Lamb's decaying vortex (Oseen 1911) at the time at which 4νt = δ².
class LambOseenLaw {
 public:
  static constexpr bool has_near_field = true;

  /// δ in m, above 0.
  explicit LambOseenLaw(double core_radius)
      : inverse_(1.0 / (core_radius * core_radius)),
        offset_(1e-30 * core_radius * core_radius),
        near_field_(one_minus_exponential_is_one * core_radius * core_radius) {}

  /// In m².
  KOKKOS_FORCEINLINE_FUNCTION double near_field() const { return near_field_; }

  /// Turns 0/0 at r = 0 into 0, which r⊥ = 0 multiplies; a pair 1e-15 δ apart is not seen to change.
  KOKKOS_FORCEINLINE_FUNCTION double offset() const { return offset_; }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION KernelFraction<Scalar> fraction(const Scalar& s) const {
    return {one_minus_exponential(Scalar(s * inverse_)), s};
  }
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION KernelSlope<Scalar> slope(const Scalar& s) const {
    const Scalar z = s * inverse_;
    const Scalar risen = one_minus_exponential(z);
    const Scalar value = risen / s;
    // (e^{−z} − (1 − e^{−z})/z)/z loses 1/z units of the last place to cancellation.
    constexpr double series_below = 0.3;
    const Scalar far = ((1.0 - risen) * inverse_ - value) / s;
    const Scalar near = series(z) * (inverse_ * inverse_);
    return {value, z < series_below ? near : far};
  }

 private:
  /// d/dz of (1 − e^{−z})/z = Σ_{k≥1} (−1)^k k z^{k−1}/(k + 1)!, to round-off for z ≤ 0.3.
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION static Scalar series(const Scalar& z) {
    Scalar sum = Scalar{} - 13.0 / 87178291200.0;
    sum = sum * z + 12.0 / 6227020800.0;
    sum = sum * z - 11.0 / 479001600.0;
    sum = sum * z + 10.0 / 39916800.0;
    sum = sum * z - 9.0 / 3628800.0;
    sum = sum * z + 8.0 / 362880.0;
    sum = sum * z - 7.0 / 40320.0;
    sum = sum * z + 6.0 / 5040.0;
    sum = sum * z - 5.0 / 720.0;
    sum = sum * z + 4.0 / 120.0;
    sum = sum * z - 3.0 / 24.0;
    sum = sum * z + 2.0 / 6.0;
    return sum * z - 0.5;
  }

  double inverse_;
  double offset_;
  double near_field_;
};

}  // namespace kiln
