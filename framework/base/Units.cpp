#include "framework/base/Units.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "framework/base/Error.hpp"
#include "framework/base/Nearest.hpp"
#include "framework/base/Pi.hpp"
#include "framework/base/Text.hpp"

namespace kiln {
namespace {

struct Symbol {
  const char* text;
  bool takes_prefix;
  Dimension dimension;
  int exponent = 0;
  double factor = 1;
  double offset = 0;
};

const std::vector<Symbol>& symbols() {
  static const std::vector<Symbol> table = {
      // m, kg, s, A, K, mol, cd
      {"m", true, {{1, 0, 0, 0, 0, 0, 0}}},
      {"g", true, {{0, 1, 0, 0, 0, 0, 0}}, -3},
      {"s", true, {{0, 0, 1, 0, 0, 0, 0}}},
      {"A", true, {{0, 0, 0, 1, 0, 0, 0}}},
      {"K", true, {{0, 0, 0, 0, 1, 0, 0}}},
      {"mol", true, {{0, 0, 0, 0, 0, 1, 0}}},
      {"cd", true, {{0, 0, 0, 0, 0, 0, 1}}},
      {"Hz", true, {{0, 0, -1, 0, 0, 0, 0}}},
      {"N", true, {{1, 1, -2, 0, 0, 0, 0}}},
      {"Pa", true, {{-1, 1, -2, 0, 0, 0, 0}}},
      {"bar", true, {{-1, 1, -2, 0, 0, 0, 0}}, 5},
      {"J", true, {{2, 1, -2, 0, 0, 0, 0}}},
      {"W", true, {{2, 1, -3, 0, 0, 0, 0}}},
      {"C", true, {{0, 0, 1, 1, 0, 0, 0}}},
      {"V", true, {{2, 1, -3, -1, 0, 0, 0}}},
      {"min", false, {{0, 0, 1, 0, 0, 0, 0}}, 0, 60},
      {"h", false, {{0, 0, 1, 0, 0, 0, 0}}, 0, 3600},
      {"degC", false, {{0, 0, 0, 0, 1, 0, 0}}, 0, 1, 273.15},
      {"°C", false, {{0, 0, 0, 0, 1, 0, 0}}, 0, 1, 273.15},
      {"1", false, {}},
      {"%", false, {}, -2},
      {"rad", true, {}},
      {"deg", false, {}, 0, pi / 180},
      {"°", false, {}, 0, pi / 180},
  };
  return table;
}

struct Prefix {
  const char* text;
  int exponent;
};

constexpr Prefix prefixes[] = {{"f", -15}, {"p", -12}, {"n", -9}, {"u", -6}, {"\u00b5", -6}, {"\u03bc", -6}, {"m", -3},
                               {"c", -2},  {"d", -1},  {"h", 2},  {"k", 3},  {"M", 6},       {"G", 9},       {"T", 12}};

std::optional<Unit> find_symbol(std::string_view text) {
  for (const Symbol& symbol : symbols()) {
    if (text == symbol.text) return Unit{symbol.dimension, symbol.exponent, symbol.factor, symbol.offset};
  }
  for (const Prefix& prefix : prefixes) {
    const std::string_view prefix_text = prefix.text;
    if (text.substr(0, prefix_text.size()) != prefix_text) continue;
    for (const Symbol& symbol : symbols()) {
      if (!symbol.takes_prefix || text.substr(prefix_text.size()) != symbol.text) continue;
      return Unit{symbol.dimension, symbol.exponent + prefix.exponent, symbol.factor, 0};
    }
  }
  return {};
}

std::string nearest_symbol(const std::string& text) {
  // Any letter is one edit away from another.
  if (text.size() < 2) return {};
  std::vector<std::string> known;
  for (const Symbol& symbol : symbols()) known.emplace_back(symbol.text);
  for (const Symbol& symbol : symbols()) {
    for (const Prefix& prefix : prefixes) {
      if (symbol.takes_prefix) known.push_back(std::string(prefix.text) + symbol.text);
    }
  }
  return nearest(text, known);
}

/// Recursive descent: quotient = product {'/' factor}; product = factor {[*·] factor}; factor = (symbol | '('
/// quotient ')') [power].
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  Unit parse() {
    const Unit unit = quotient(0);
    if (at_ < text_.size()) refuse(fmt::format("there is no place for {}", in_quotes(std::string(text_.substr(at_)))));
    return unit;
  }

 private:
  [[noreturn]] void refuse(std::string found, std::string expected = {}, std::string suggestion = {}) const {
    throw InputError("", fmt::format("{} is no unit: {}", in_quotes(std::string(text_)), found), std::move(expected),
                     std::move(suggestion));
  }

  bool take(std::string_view token) {
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool at_end() const { return at_ == text_.size() || text_[at_] == ')'; }

  Unit quotient(int depth) {
    Unit unit = factor(depth);
    bool divided = false;
    for (;;) {
      skip_spaces();
      if (at_end()) return unit;
      if (take("/")) {
        skip_spaces();
        unit = times(unit, factor(depth), -1);
        divided = true;
        continue;
      }
      if (divided) refuse("a product after '/' is ambiguous", "parentheses, as in 'W/(m K)'");
      if (!take("*")) take("·");
      skip_spaces();
      unit = times(unit, factor(depth), 1);
    }
  }

  Unit factor(int depth) {
    Unit unit;
    if (take("(")) {
      if (depth > 8) refuse("too many parentheses");
      skip_spaces();
      unit = quotient(depth + 1);
      if (!take(")")) refuse("')' is missing");
    } else {
      unit = symbol();
    }
    const std::size_t before = at_;
    const int exponent = power();
    if (at_ != before) {
      if (unit.offset != 0) refuse_offset();
      unit = times({}, unit, exponent);
    }
    return unit;
  }

  Unit symbol() {
    const std::size_t begin = at_;
    if (!take("1")) {
      while (at_ < text_.size() && !ends_symbol()) ++at_;
    }
    const std::string name(text_.substr(begin, at_ - begin));
    if (name.empty()) refuse("a symbol is missing");
    const std::optional<Unit> unit = find_symbol(name);
    if (!unit) refuse(fmt::format("there is no {}", in_quotes(name)), {}, nearest_symbol(name));
    return *unit;
  }

  bool ends_symbol() const {
    const auto c = static_cast<unsigned char>(text_[at_]);
    if (std::isdigit(c) != 0 || std::string_view(" */()^-+").find(static_cast<char>(c)) != std::string_view::npos) {
      return true;
    }
    const std::string_view rest = text_.substr(at_);
    for (const std::string_view end : {"·", "⁻", "⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"}) {
      if (rest.substr(0, end.size()) == end) return true;
    }
    return false;
  }

  int power() {
    static constexpr std::string_view raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    if (take("⁻")) return -raised_digit(raised);
    for (int digit = 0; digit < 10; ++digit) {
      if (take(raised[digit])) return digit;
    }
    const bool marked = take("^") || take("**");
    int sign = 1;
    if (take("-")) {
      sign = -1;
    } else {
      take("+");
    }
    if (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0) {
      const int digit = text_[at_++] - '0';
      if (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0) refuse("a power above 9");
      return sign * digit;
    }
    if (marked || sign < 0) refuse("a power is missing", "a whole number, as in 's^-2'");
    return 1;
  }

  int raised_digit(const std::string_view (&raised)[10]) {
    for (int digit = 0; digit < 10; ++digit) {
      if (take(raised[digit])) return digit;
    }
    refuse("a power is missing");
  }

  Unit times(Unit a, const Unit& b, int power) const {
    if (a.offset != 0 || b.offset != 0) refuse_offset();
    for (std::size_t i = 0; i < a.dimension.powers.size(); ++i) a.dimension.powers[i] += power * b.dimension.powers[i];
    a.exponent += power * b.exponent;
    a.factor *= std::pow(b.factor, power);
    return a;
  }

  [[noreturn]] void refuse_offset() const { refuse("degC has its own zero", "K in products and powers"); }

  std::string_view text_;
  std::size_t at_ = 0;
};

struct NamedDimension {
  const char* name;
  Dimension dimension;
};

const std::vector<NamedDimension>& named_dimensions() {
  static const std::vector<NamedDimension> table = {
      {"length", {{1}}},
      {"area", {{2}}},
      {"volume", {{3}}},
      {"mass", {{0, 1}}},
      {"density", {{-3, 1}}},
      {"time", {{0, 0, 1}}},
      {"frequency", {{0, 0, -1}}},
      {"speed", {{1, 0, -1}}},
      {"acceleration", {{1, 0, -2}}},
      {"diffusivity", {{2, 0, -1}}},
      {"force", {{1, 1, -2}}},
      {"pressure", {{-1, 1, -2}}},
      {"viscosity", {{-1, 1, -1}}},
      {"energy", {{2, 1, -2}}},
      {"specific energy", {{2, 0, -2}}},
      {"power", {{2, 1, -3}}},
      {"heat flux", {{0, 1, -3}}},
      {"heat source density", {{-1, 1, -3}}},
      {"temperature", {{0, 0, 0, 0, 1}}},
      {"temperature gradient", {{-1, 0, 0, 0, 1}}},
      {"temperature rate", {{0, 0, -1, 0, 1}}},
      {"thermal conductivity", {{1, 1, -3, 0, -1}}},
      {"heat transfer coefficient", {{0, 1, -3, 0, -1}}},
      {"heat capacity", {{2, 1, -2, 0, -1}}},
      {"specific heat capacity", {{2, 0, -2, 0, -1}}},
      {"current", {{0, 0, 0, 1}}},
      {"voltage", {{2, 1, -3, -1}}},
      {"charge", {{0, 0, 1, 1}}},
      {"amount of substance", {{0, 0, 0, 0, 0, 1}}},
      {"luminous intensity", {{0, 0, 0, 0, 0, 0, 1}}},
  };
  return table;
}

/// Length of the number a text begins with, digits with at most one point and a power of ten; 0: none.
std::size_t number_length(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0) ++i;
    return i - begin;
  };
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  std::size_t count = digits();
  if (i < text.size() && text[i] == '.') {
    ++i;
    count += digits();
  }
  if (count == 0) return 0;
  const std::size_t mantissa_end = i;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) return mantissa_end;
  }
  return i;
}

bool is_not_finite(std::string_view text) {
  std::string word;
  for (const char c : text) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.erase(0, 1);
  if (!word.empty() && word[0] == '.') word.erase(0, 1);
  return word == "nan" || word == "inf" || word == "infinity";
}

/// number · 10^exponent, rounded once.
double scaled(std::string_view text, std::string_view number, int exponent) {
  if (number[0] == '+') number.remove_prefix(1);
  std::string mantissa(number);
  const std::size_t e = mantissa.find_first_of("eE");
  long long total = exponent;
  if (e != std::string::npos) {
    // Beyond a thousand every double is 0 or infinite; the cut keeps the sum within an integer.
    const std::string digits = mantissa.substr(e + 1);
    total += digits.size() > 6 ? (digits[0] == '-' ? -1000000 : 1000000) : std::stoll(digits);
    mantissa.erase(e);
  }
  const std::string written = fmt::format("{}e{}", mantissa, total);
  double value = 0;
  const auto result = std::from_chars(written.data(), written.data() + written.size(), value);
  if (result.ec != std::errc() || !std::isfinite(value)) {
    throw InputError("", fmt::format("{} is beyond double precision", in_quotes(std::string(text))));
  }
  return value;
}

}  // namespace

std::string to_string(const Dimension& dimension) {
  // kg first, as in "kg m²/s³".
  static const std::pair<std::size_t, const char*> order[] = {{1, "kg"}, {0, "m"},   {2, "s"}, {3, "A"},
                                                              {4, "K"},  {5, "mol"}, {6, "cd"}};
  static const char* raised[] = {"⁰", "", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string above, below;
  int below_count = 0;
  for (const auto& [index, symbol] : order) {
    const int power = dimension.powers[index];
    if (power == 0) continue;
    std::string& side = power > 0 ? above : below;
    const int size = std::abs(power);
    side += (side.empty() ? "" : " ") + std::string(symbol) + (size < 10 ? raised[size] : fmt::format("^{}", size));
    if (power < 0) ++below_count;
  }
  if (above.empty()) above = "1";
  if (below_count == 0) return above;
  return above + "/" + (below_count == 1 ? below : "(" + below + ")");
}

std::string name_of(const Dimension& dimension) {
  for (const NamedDimension& named : named_dimensions()) {
    if (named.dimension == dimension) return named.name;
  }
  return {};
}

std::string with_article(const Dimension& dimension) {
  const std::string name = name_of(dimension);
  if (name.empty()) return "a number";
  const bool vowel = std::string_view("aeiou").find(name[0]) != std::string_view::npos;
  return (vowel ? "an " : "a ") + name;
}

std::vector<std::string> symbols_of(const Dimension& dimension) {
  std::vector<std::string> known;
  for (const Symbol& symbol : symbols()) {
    if (symbol.dimension != dimension) continue;
    known.emplace_back(symbol.text);
    for (const Prefix& prefix : prefixes) {
      if (symbol.takes_prefix) known.push_back(std::string(prefix.text) + symbol.text);
    }
  }
  return known;
}

Unit parse_unit(std::string_view text) { return UnitParser(text).parse(); }

Quantity parse_quantity(std::string_view text) {
  const std::size_t length = number_length(text);
  const std::string_view number = text.substr(0, length);
  std::string_view rest = text.substr(length);
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  const bool hexadecimal = number == "0" && !rest.empty() && (rest.front() == 'x' || rest.front() == 'X');
  if (length == 0 || hexadecimal ||
      (!rest.empty() && std::string_view(".,_:;").find(rest.front()) != std::string_view::npos) ||
      (!rest.empty() && rest.substr(0, 2) != "1/" && std::isdigit(static_cast<unsigned char>(rest.front())) != 0)) {
    const bool not_finite = is_not_finite(text);
    throw InputError("", fmt::format("{} is not {}", in_quotes(std::string(text)), not_finite ? "finite" : "a number"));
  }
  if (rest.empty()) return {scaled(text, number, 0), false, {}};
  const Unit unit = parse_unit(rest);
  if (unit.offset != 0) {
    return {scaled(text, number, unit.exponent) * unit.factor + unit.offset, true, unit.dimension, true};
  }
  const double value = scaled(text, number, unit.exponent) * unit.factor;
  if (!std::isfinite(value)) {
    throw InputError("", fmt::format("{} is beyond double precision", in_quotes(std::string(text))));
  }
  return {value, true, unit.dimension};
}

}  // namespace kiln
