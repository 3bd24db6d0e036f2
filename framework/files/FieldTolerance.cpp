#include "framework/files/FieldTolerance.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

bool is_like(const char* name, const char* pattern) {
  if (*pattern == '\0') return *name == '\0';
  if (*pattern == '*') return is_like(name, pattern + 1) || (*name != '\0' && is_like(name + 1, pattern));
  return *name == *pattern && is_like(name + 1, pattern + 1);
}

}  // namespace

bool FieldTolerance::matches(const std::string& field) const { return is_like(field.c_str(), fields.c_str()); }

FieldTolerance field_tolerance(const std::string& text) {
  const auto number = [&text](const std::string& digits) {
    double value = 0.0;
    const char* last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, value);
    if (error != std::errc() || end != last || !std::isfinite(value) || value < 0.0) {
      throw InputError("--field " + text, fmt::format("'{}' is no finite number of at least 0", digits),
                       "FIELDS=TOLERANCE or FIELDS=TOLERANCE,FLOOR");
    }
    return value;
  };
  // A field's name may contain '='; a number does not.
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--field " + text, equals == 0 ? "no field is named" : "there is no '='",
                     "FIELDS=TOLERANCE or FIELDS=TOLERANCE,FLOOR");
  }
  const std::size_t comma = text.find(',', equals);
  const bool has_floor = comma != std::string::npos;
  FieldTolerance result;
  result.fields = text.substr(0, equals);
  result.tolerance = number(text.substr(equals + 1, has_floor ? comma - equals - 1 : std::string::npos));
  if (has_floor) result.floor = number(text.substr(comma + 1));
  return result;
}

}  // namespace kiln
