#pragma once

#include <complex>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

class Material;

/// The real number that decides which interval of a table a scalar lies in: its value without derivatives.
KOKKOS_INLINE_FUNCTION double value_of(double x) { return x; }
inline double value_of(const std::complex<double>& x) { return x.real(); }
template <class Fad>
KOKKOS_INLINE_FUNCTION auto value_of(const Fad& x) -> decltype(static_cast<double>(x.val())) {
  return x.val();
}

/// Material properties at one temperature.
template <class Scalar>
struct MaterialPoint {
  Scalar conductivity;   ///< k in W/(m K)
  Scalar specific_heat;  ///< c in J/(kg K)
  Scalar density;        ///< ρ in kg/m³
};

/// Properties of a material over temperature, in equal steps with linear interpolation between (Eqs. 18–20) and the end
/// values outside. Cheap to copy into kernels.
class MaterialTable {
 public:
  /// Reads the material at from, from + step, … up to `to` at least (K). `path` names the material in the input. Throws
  /// InputError when the range is empty or a property is not finite and above 0 somewhere.
  MaterialTable(const Material& material, double from, double to, double step, const std::string& path);
  /// From values() of another table: k, c, ρ at from, from + step, … Throws std::invalid_argument for fewer than two.
  MaterialTable(double from, double step, const std::vector<double>& values);

  /// Properties at temperature u (K), of any scalar type: derivatives with respect to u ride along.
  template <class Scalar>
  KOKKOS_INLINE_FUNCTION MaterialPoint<Scalar> at(const Scalar& u) const {
    const double place = (value_of(u) - from_) * inverse_step_;
    if (place < 0.0) return {Scalar(values_(0, 0)), Scalar(values_(0, 1)), Scalar(values_(0, 2))};
    // Written so that NaN ends here as well; a temperature that is not a number shows in the temperature difference.
    if (!(place < intervals_)) {
      return {Scalar(values_(intervals_, 0)), Scalar(values_(intervals_, 1)), Scalar(values_(intervals_, 2))};
    }
    const auto i = static_cast<LocalIndex>(place);
    const Scalar fraction = (u - from_) * inverse_step_ - static_cast<double>(i);
    return {values_(i, 0) + fraction * (values_(i + 1, 0) - values_(i, 0)),
            values_(i, 1) + fraction * (values_(i + 1, 1) - values_(i, 1)),
            values_(i, 2) + fraction * (values_(i + 1, 2) - values_(i, 2))};
  }

  /// The interval of the table that at(u) interpolates in, and how far into it u lies: 0 and 1 where at(u) takes an end
  /// of the table. Without a branch, for vectors.
  KOKKOS_FORCEINLINE_FUNCTION int interval(double u, double& fraction) const {
    double place = (u - from_) * inverse_step_;
    // Not a number ends at the table's end, as in at().
    place = place < intervals_ ? place : intervals_;
    place = place > 0.0 ? place : 0.0;
    const int i = static_cast<int>(place);
    const int inside = i < intervals_ ? i : intervals_ - 1;
    fraction = place - inside;
    return inside;
  }

  /// d/du of the properties, per K: those of the interval u lies in, 0 outside the table.
  KOKKOS_INLINE_FUNCTION MaterialPoint<double> slopes(double u) const {
    const double place = (u - from_) * inverse_step_;
    if (!(place >= 0.0 && place < intervals_)) return {0.0, 0.0, 0.0};
    const auto i = static_cast<LocalIndex>(place);
    return {(values_(i + 1, 0) - values_(i, 0)) * inverse_step_, (values_(i + 1, 1) - values_(i, 1)) * inverse_step_,
            (values_(i + 1, 2) - values_(i, 2)) * inverse_step_};
  }

  double from() const { return from_; }
  double step() const { return step_; }
  /// k, c, ρ of each table temperature, one after the other.
  std::vector<double> values() const;

 private:
  double from_;
  double step_;
  double inverse_step_;
  LocalIndex intervals_;
  Kokkos::View<const double* [3], Kokkos::LayoutRight, Device> values_;
};

}  // namespace kiln
