#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace kiln {

/// Powers of metre, kilogram, second, ampere, kelvin, mole and candela. Angles are pure numbers.
struct Dimension {
  std::array<int, 7> powers{};
  bool operator==(const Dimension& other) const { return powers == other.powers; }
  bool operator!=(const Dimension& other) const { return powers != other.powers; }
};

/// In base units: "kg m²/s³"; "1" for a pure number.
std::string to_string(const Dimension& dimension);
/// "length", "power", …; empty for a dimension without a usual name, and for a pure number.
std::string name_of(const Dimension& dimension);
/// "a length", "an energy"; "a number" where there is no name.
std::string with_article(const Dimension& dimension);

/// A value x in this unit is (x + offset) · factor · 10^exponent in SI.
struct Unit {
  Dimension dimension;
  int exponent = 0;  ///< kept apart, so that 50 um is exactly 5e-5 m
  double factor = 1;
  double offset = 0;
};

/// Reads a unit: symbols of the SI with their prefixes (also % min h deg degC bar), powers ("s^-2", "m2", "m²"),
/// products ("Pa s", "Pa*s", "Pa·s") and quotients ("W/m/K", "W/(m K)"). A product after a quotient needs parentheses:
/// "W/m K" is refused, since readers disagree on it. Throws InputError.
Unit parse_unit(std::string_view text);

/// Symbols of that dimension, with their prefixes: "m", "um", "mm", … for a length. None for a product of several.
std::vector<std::string> symbols_of(const Dimension& dimension);

/// A number with or without a unit.
struct Quantity {
  double value;                ///< in SI; as written without a unit
  bool has_unit;               ///< false: the number stands alone
  Dimension dimension;         ///< of the unit
  bool from_own_zero = false;  ///< the unit counts from a zero of its own, as degC does
};

/// Reads "50 um", "4e-6", "25 W/(m K)", "20 degC". Throws InputError for anything else, for infinity, NaN and what
/// double precision cannot hold. SI prefixes do not round: "50 um" is the double nearest to 5e-5.
Quantity parse_quantity(std::string_view text);

}  // namespace kiln
