#include "framework/driver/Placeholders.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "framework/base/Error.hpp"
#include "framework/base/Nearest.hpp"
#include "framework/base/Text.hpp"

namespace kiln {
namespace {

const std::string& value_of(const std::string& name, const std::string& text, const PlaceholderValues& values) {
  const auto known = std::find_if(values.begin(), values.end(), [&](const auto& pair) { return pair.first == name; });
  if (known != values.end()) return known->second;
  std::vector<std::string> names;
  for (const auto& [other, value] : values) names.push_back(other);
  const std::string expected = names.empty() ? "no placeholders: the case has no block 'for'"
                                             : fmt::format("one of: {}", fmt::join(names, ", "));
  throw InputError("", fmt::format("{{{}}} in {} has no value", shown(name), in_quotes(text)), expected,
                   nearest(name, names));
}

}  // namespace

std::string fill_placeholders(const std::string& text, const PlaceholderValues& values) {
  const char* const expected = "{name}, or '{{' and '}}' for braces";
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '{' && text[i] != '}') {
      result += text[i];
      continue;
    }
    if (i + 1 < text.size() && text[i + 1] == text[i]) {
      result += text[i++];
      continue;
    }
    const std::size_t end = text.find_first_of("{}", i + 1);
    if (text[i] == '}' || end == std::string::npos || text[end] == '{') {
      throw InputError("", fmt::format("'{}' without its partner in {}", text[i], in_quotes(text)), expected);
    }
    result += value_of(text.substr(i + 1, end - i - 1), text, values);
    i = end;
  }
  return result;
}

std::vector<PlaceholderValues> combinations(
    const std::vector<std::pair<std::string, std::vector<std::string>>>& names) {
  std::vector<PlaceholderValues> result(1);
  for (const auto& [name, values] : names) {
    std::vector<PlaceholderValues> longer;
    for (const PlaceholderValues& start : result) {
      for (const std::string& value : values) {
        longer.push_back(start);
        longer.back().emplace_back(name, value);
      }
    }
    result = std::move(longer);
  }
  return result;
}

}  // namespace kiln
