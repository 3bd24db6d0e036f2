#pragma once

#include <Teuchos_ParameterList.hpp>
#include <complex>
#include <string>
#include <type_traits>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/MaterialPieces.hpp"

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
    const int i = interval(value, fraction);
    if constexpr (std::is_same_v<Scalar, double>) {
      return interpolated(i, fraction);
    } else {
      return interpolated(i, Scalar(fraction + (u - value) * (value < from_ ? 0.0 : inverse_step_)));
    }
  }

  /// The row at or below u, and how far u lies from it to the next one, less than 1; 0 outside the table. Without a
  /// branch, for vectors.
  KOKKOS_FORCEINLINE_FUNCTION int interval(double u, double& fraction) const {
    const double place = place_of(u, static_cast<double>(intervals_));
    const int i = static_cast<int>(place);
    fraction = place - i;
    return i;
  }
  /// How many rows, and what part of one, u lies above the first: for vectors of temperatures as for one.
  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION Number place_of(const Number& u, const Number& last) const {
    const Number place = (u - from_) * inverse_step_;
    const Number below = place < last ? place : last;
    return below > 0.0 ? below : Number{};
  }
  /// The place of the table's last row.
  KOKKOS_FORCEINLINE_FUNCTION double last_place() const { return intervals_; }
  /// In their place, where the rows are those of few polynomials; else nullptr.
  KOKKOS_FORCEINLINE_FUNCTION const MaterialPieces* pieces() const { return pieces_; }
  /// A property of a piece, x rows from its first one; see MaterialPieces.
  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION static Number of_piece(const Number& value, const Number& first, const Number& second,
                                                     const Number& x, const Number& fraction) {
    return value + (x * (first + x * second) + (fraction - fraction * fraction) * second);
  }
  /// One row for each tabulated temperature, in a kernel.
  KOKKOS_FORCEINLINE_FUNCTION const MaterialRow* rows() const { return rows_; }

  /// d/du of the properties, per K: those of the interval u lies in, 0 outside the table.
  KOKKOS_INLINE_FUNCTION MaterialPoint<double> slopes(double u) const {
    const double place = (u - from_) * inverse_step_;
    if (!(place >= 0.0 && place < intervals_)) return {0.0, 0.0, 0.0};
    const auto i = static_cast<LocalIndex>(place);
    if (pieces_ != nullptr) {
      const int piece = pieces_->piece_at(i);
      const double sides = 2.0 * (i - pieces_->starts[piece]) + 1.0;
      const auto slope = [&](int k) {
        return (pieces_->firsts[k][piece] + sides * pieces_->seconds[k][piece]) * inverse_step_;
      };
      return {slope(0), slope(1), slope(2)};
    }
    const MaterialRow& row = rows_[i];
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
  const MaterialPieces* pieces_ = nullptr;

 private:
  template <class Scalar>
  KOKKOS_FORCEINLINE_FUNCTION MaterialPoint<Scalar> interpolated(int i, const Scalar& fraction) const {
    if (pieces_ != nullptr) {
      const int piece = pieces_->piece_at(i);
      const Scalar x = (i - pieces_->starts[piece]) + fraction;
      const auto property = [&](int k) {
        return of_piece(Scalar(pieces_->values[k][piece]), Scalar(pieces_->firsts[k][piece]),
                        Scalar(pieces_->seconds[k][piece]), x, fraction);
      };
      return {property(0), property(1), property(2)};
    }
    const MaterialRow& row = rows_[i];
    return {row.values[0] + fraction * row.differences[0], row.values[1] + fraction * row.differences[1],
            row.values[2] + fraction * row.differences[2]};
  }
};

/// The block `table` of a model: at which temperatures (K) a material's properties are tabulated.
struct TableRange {
  double from = 200.0, to = 6000.0, step = 1.0;
  /// As a model's checked block has it.
  static TableRange of(const Teuchos::ParameterList& model);
  /// Whole steps that reach `to`. Not a number where the range is none.
  double intervals() const;
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
  Kokkos::View<const MaterialPieces*, Device> held_pieces_;  ///< one or none
};

}  // namespace kiln
