#pragma once

#include <complex>
#include <string>
#include <type_traits>
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

/// k, c, ρ at a tabulated temperature and their differences to the next one's (0 at the table's end), in one cache
/// line. The fourth number is nothing: vectors load four at once.
struct alignas(64) MaterialRow {
  double values[4];
  double differences[4];
};

/// Properties of a material over temperature, in equal steps with linear interpolation between (Eqs. 18–20) and the end
/// values outside. What kernels copy of a MaterialTable, which must outlive it.
class MaterialLookup {
 public:
  /// Properties at temperature u (K), of any scalar type: derivatives with respect to u ride along. A temperature that
  /// is not a number has those of the table's end; it shows in the temperature differences.
  template <class Scalar>
  KOKKOS_INLINE_FUNCTION MaterialPoint<Scalar> at(const Scalar& u) const {
    const double value = value_of(u);
    double fraction;
    const MaterialRow& row = rows_[interval(value, fraction)];
    if constexpr (std::is_same_v<Scalar, double>) {
      return interpolated(row, fraction);
    } else {
      return interpolated(row, Scalar(fraction + (u - value) * (value < from_ ? 0.0 : inverse_step_)));
    }
  }

  /// The row at or below u, and how far u lies from it to the next one, less than 1; 0 outside the table. Without a
  /// branch, for vectors.
  KOKKOS_FORCEINLINE_FUNCTION int interval(double u, double& fraction) const {
    double place = (u - from_) * inverse_step_;
    place = place < intervals_ ? place : intervals_;
    place = place > 0.0 ? place : 0.0;
    const int i = static_cast<int>(place);
    fraction = place - i;
    return i;
  }
  /// One row for each tabulated temperature, in a kernel.
  KOKKOS_FORCEINLINE_FUNCTION const MaterialRow* rows() const { return rows_; }

  /// d/du of the properties, per K: those of the interval u lies in, 0 outside the table.
  KOKKOS_INLINE_FUNCTION MaterialPoint<double> slopes(double u) const {
    const double place = (u - from_) * inverse_step_;
    if (!(place >= 0.0 && place < intervals_)) return {0.0, 0.0, 0.0};
    const MaterialRow& row = rows_[static_cast<LocalIndex>(place)];
    return {row.differences[0] * inverse_step_, row.differences[1] * inverse_step_, row.differences[2] * inverse_step_};
  }

 protected:
  MaterialLookup(double from, double step, LocalIndex intervals)
      : from_(from), step_(step), inverse_step_(1.0 / step), intervals_(intervals) {}

  double from_;
  double step_;
  double inverse_step_;
  LocalIndex intervals_;
  const MaterialRow* rows_ = nullptr;  ///< intervals_ + 1 of them, on the device

 private:
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION static MaterialPoint<Scalar> interpolated(const MaterialRow& row,
                                                                        const Scalar& fraction) {
    return {row.values[0] + fraction * row.differences[0], row.values[1] + fraction * row.differences[1],
            row.values[2] + fraction * row.differences[2]};
  }
};

/// The table itself. Copies share its rows.
class MaterialTable : public MaterialLookup {
 public:
  /// Reads the material at from, from + step, … up to `to` at least (K). `path` names the material in the input. Throws
  /// InputError when the range is empty or a property is not finite and above 0 somewhere.
  MaterialTable(const Material& material, double from, double to, double step, const std::string& path);
  /// From values() of another table: k, c, ρ at from, from + step, … Throws std::invalid_argument for fewer than two.
  MaterialTable(double from, double step, const std::vector<double>& values);

  double from() const { return from_; }
  double step() const { return step_; }
  /// k, c, ρ of each table temperature, one after the other.
  std::vector<double> values() const;

 private:
  Kokkos::View<const MaterialRow*, Device> held_;
};

}  // namespace kiln
