#include "framework/base/Units.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

TEST(Units, AreReadExactly) {
  struct Case {
    const char* text;
    double value;
    const char* dimension;
  };
  const Case cases[] = {
      {"50 um", 5e-5, "m"},
      {"50 µm", 5e-5, "m"},
      {"50 \u03bcm", 5e-5, "m"},
      {"50um", 5e-5, "m"},
      {"0.364 mm", 0.364e-3, "m"},
      {"3 cm", 0.03, "m"},
      {"40 W", 40, "kg m²/s³"},
      {"2.5 kW", 2500, "kg m²/s³"},
      {"4 us", 4e-6, "s"},
      {"2 min", 120, "s"},
      {"1.5 h", 5400, "s"},
      {"0.5 m/s", 0.5, "m/s"},
      {"500 mm/s", 0.5, "m/s"},
      {"9.81 m/s^2", 9.81, "m/s²"},
      {"9.81 m s-2", 9.81, "m/s²"},
      {"9.81 m·s⁻²", 9.81, "m/s²"},
      {"9.81 m*s**-2", 9.81, "m/s²"},
      {"2 mm²", 2e-6, "m²"},
      {"2 mm^3", 2e-9, "m³"},
      {"293.15 K", 293.15, "K"},
      {"20 degC", 293.15, "K"},
      {"20 °C", 293.15, "K"},
      {"99.9 %", 0.999, "1"},
      {"180 deg", 3.14159265358979323846, "1"},
      {"2 mrad", 2e-3, "1"},
      {"25 W/m/K", 25, "kg m/(s³ K)"},
      {"25 W/(m K)", 25, "kg m/(s³ K)"},
      {"25 W m^-1 K^-1", 25, "kg m/(s³ K)"},
      {"7900 kg/m3", 7900, "kg/m³"},
      {"7.9 g/cm^3", 7900, "kg/m³"},
      {"490 J/kg/K", 490, "m²/(s² K)"},
      {"10 W/(m^2 K)", 10, "kg/(s³ K)"},
      {"1 (m/s)^2", 1, "m²/s²"},
      {"1e5 Pa", 1e5, "kg/(m s²)"},
      {"1 bar", 1e5, "kg/(m s²)"},
      {"3 mbar", 300, "kg/(m s²)"},
      {"10 kHz", 1e4, "1/s"},
      {"10 1/s", 10, "1/s"},
      {"-4e-3 m", -4e-3, "m"},
      {"+.5 m", 0.5, "m"},
      {"5. m", 5, "m"},
      {"2 mol", 2, "mol"},
      {"1 A", 1, "A"},
  };
  for (const Case& one : cases) {
    const Quantity quantity = parse_quantity(one.text);
    EXPECT_EQ(quantity.value, one.value) << one.text;
    EXPECT_EQ(to_string(quantity.dimension), one.dimension) << one.text;
    EXPECT_TRUE(quantity.has_unit) << one.text;
  }
}

TEST(Units, PlainNumbersStayAsTheyAre) {
  for (const auto& [text, value] :
       {std::pair{"4e-6", 4e-6}, {"4", 4.0}, {"200", 200.0}, {"-0.1", -0.1}, {"1E+3", 1e3}}) {
    EXPECT_EQ(parse_quantity(text).value, value) << text;
    EXPECT_FALSE(parse_quantity(text).has_unit) << text;
  }
}

/// A prefix must not add an error of its own: "x um" is the double nearest to x·10⁻⁶.
TEST(Units, PrefixesDoNotRound) {
  for (int i = 1; i < 1000; ++i) {
    EXPECT_EQ(parse_quantity(std::to_string(i) + " um").value, std::stod(std::to_string(i) + "e-6"));
    EXPECT_EQ(parse_quantity(std::to_string(i) + " nm").value, std::stod(std::to_string(i) + "e-9"));
  }
}

TEST(Units, WrongTextsAreRefused) {
  struct Case {
    const char* text;
    const char* message;
  };
  const Case cases[] = {
      {"", "'' is not a number"},
      {"W", "'W' is not a number"},
      {"1.2.3", "'1.2.3' is not a number"},
      {"1,5 m", "'1,5 m' is not a number"},
      {"1 2", "'1 2' is not a number"},
      {"NaN", "'NaN' is not finite"},
      {"+.Inf", "'+.Inf' is not finite"},
      {"1e400", "'1e400' is beyond double precision"},
      {"1e300 Tm", "'1e300 Tm' is beyond double precision"},
      {"1e-400", "'1e-400' is beyond double precision"},
      {"1e99999999999999999999 m", "'1e99999999999999999999 m' is beyond double precision"},
      {"50 mW/K m", "'mW/K m' is no unit: a product after '/' is ambiguous; expected parentheses, as in 'W/(m K)'"},
      {"50 micron", "'micron' is no unit: there is no 'micron'"},
      {"5 m^", "'m^' is no unit: a power is missing; expected a whole number, as in 's^-2'"},
      {"5 m^20", "'m^20' is no unit: a power above 9"},
      {"5 m/", "'m/' is no unit: a symbol is missing"},
      {"5 (m", "'(m' is no unit: ')' is missing"},
      {"5 m)", "'m)' is no unit: there is no place for ')'"},
      {"5 W/degC", "'W/degC' is no unit: degC has its own zero; expected K in products and powers"},
      {"5 kmin", nullptr},
      {"5 mdegC", nullptr},
      {"5 ((((((((((((m))))))))))))", "'((((((((((((m))))))))))))' is no unit: too many parentheses"},
  };
  for (const Case& one : cases) {
    if (one.message == nullptr) {
      EXPECT_THROW(parse_quantity(one.text), InputError) << one.text;
      continue;
    }
    try {
      parse_quantity(one.text);
      ADD_FAILURE() << one.text << " was read";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), one.message);
    }
  }
}

TEST(Units, NearestUnitIsSuggested) {
  try {
    parse_quantity("3 umm");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().suggestion, "um");
  }
}

TEST(Units, DimensionsHaveNames) {
  EXPECT_EQ(name_of(parse_unit("W/(m K)").dimension), "thermal conductivity");
  EXPECT_EQ(name_of(parse_unit("J/kg/K").dimension), "specific heat capacity");
  EXPECT_EQ(with_article(parse_unit("J").dimension), "an energy");
  EXPECT_EQ(with_article(parse_unit("m").dimension), "a length");
  EXPECT_EQ(with_article(parse_unit("1").dimension), "a number");
  EXPECT_EQ(with_article(parse_unit("m^5").dimension), "a number");
}

}  // namespace
}  // namespace kiln
