#include "framework/input/Value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "framework/base/Nearest.hpp"
#include "framework/base/Text.hpp"
#include "framework/base/Units.hpp"
#include "framework/files/DataFiles.hpp"
#include "framework/registry/EntryText.hpp"

namespace kiln {
namespace {

using Kind = Entry::Kind;

/// A mistake whose path and expectation the caller knows.
[[noreturn]] void refuse(std::string found, std::string suggestion = {}) {
  throw InputError("", std::move(found), {}, std::move(suggestion));
}

std::string wrong_dimension(const std::string& text, const Dimension& dimension) {
  const std::string name = name_of(dimension);
  if (!name.empty())
    return fmt::format("{} is {} ({})", in_quotes(text), with_article(dimension), to_string(dimension));
  if (dimension == Dimension{}) return fmt::format("{} is a pure number", in_quotes(text));
  return fmt::format("{} has the dimension {}", in_quotes(text), to_string(dimension));
}

void check_range(double value, const std::string& text, const Entry& entry) {
  if (entry.lower && (entry.open_lower ? value <= *entry.lower : value < *entry.lower)) {
    refuse(fmt::format("{} is {} {}", in_quotes(text), entry.open_lower ? "not above" : "below",
                       bound_text(*entry.lower, entry)));
  }
  if (entry.upper && (entry.open_upper ? value >= *entry.upper : value > *entry.upper)) {
    refuse(fmt::format("{} is {} {}", in_quotes(text), entry.open_upper ? "not below" : "above",
                       bound_text(*entry.upper, entry)));
  }
}

void require_scalar(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::scalar) refuse(what_is_given(node));
  if (node.text.empty()) refuse("an empty text is given");
}

[[noreturn]] void throw_wrong_default(const Entry& entry) {
  throw std::logic_error(
      fmt::format("the default of the key '{}' is not of its type, {}", entry.key, type_text(entry)));
}

Problem at(const std::string& path, const InputError& error, const Entry& entry) {
  Problem problem = error.problems().front();
  problem.path = path;
  if (problem.expected.empty()) problem.expected = expectation(entry);
  return problem;
}

template <class T>
std::vector<double> as_doubles(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

}  // namespace

std::string what_is_given(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "no value is given";
    case YamlNode::Kind::scalar:
      return fmt::format("a single value {} is given", in_quotes(node.text));
    case YamlNode::Kind::list:
      return "a list is given";
    case YamlNode::Kind::map:
      return "a block is given";
  }
  throw std::logic_error("a YAML value without a kind");
}

double ValueReader::real(const YamlNode& node, const Entry& entry) const {
  require_scalar(node);
  const Quantity quantity = parse_quantity(node.text);
  const Unit unit = parse_unit(entry.unit);
  if (quantity.has_unit && quantity.dimension != unit.dimension) refuse(wrong_dimension(node.text, quantity.dimension));
  if (quantity.from_own_zero && entry.is_difference) {
    refuse(fmt::format("{} counts from a zero of its own, and a difference is meant", in_quotes(node.text)));
  }
  check_range(quantity.value, node.text, entry);
  return quantity.value;
}

int ValueReader::integer(const YamlNode& node, const Entry& entry) const {
  require_scalar(node);
  const std::string& text = node.text;
  const std::string digits = text[0] == '+' ? text.substr(1) : text;
  int value = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (result.ec == std::errc::result_out_of_range) {
    constexpr int largest = std::numeric_limits<int>::max();
    refuse(text[0] == '-' ? fmt::format("{} is below {}", in_quotes(text), std::numeric_limits<int>::min())
                          : fmt::format("{} is above {}", in_quotes(text), largest));
  }
  if (result.ec != std::errc() || result.ptr != digits.data() + digits.size()) {
    std::string meant;
    try {
      const Quantity quantity = parse_quantity(text);
      if (!quantity.has_unit && std::abs(quantity.value) < 2e9 && std::trunc(quantity.value) == quantity.value) {
        meant = fmt::format("{}", static_cast<int>(quantity.value));
      }
    } catch (const InputError&) {
      // Not a number at all: nothing to suggest.
    }
    refuse(fmt::format("{} is not an integer", in_quotes(text)), meant);
  }
  check_range(value, text, entry);
  return value;
}

bool ValueReader::flag(const YamlNode& node) const {
  require_scalar(node);
  std::string word;
  for (const char c : node.text) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word == "true") return true;
  if (word == "false") return false;
  std::string meant = nearest(word, {"true", "false"});
  if (word == "yes" || word == "on" || word == "1" || word == "y") meant = "true";
  if (word == "no" || word == "off" || word == "0" || word == "n") meant = "false";
  refuse(fmt::format("{} is not a flag", in_quotes(node.text)), meant);
}

std::string ValueReader::choice(const YamlNode& node, const Entry& entry) const {
  require_scalar(node);
  if (std::find(entry.choices.begin(), entry.choices.end(), node.text) == entry.choices.end()) {
    refuse(fmt::format("{} is no choice", in_quotes(node.text)), nearest(node.text, entry.choices));
  }
  return node.text;
}

std::string ValueReader::file(const std::string& name, const Location& location) {
  const std::filesystem::path folder =
      location.line == 0 ? std::filesystem::path(folder_) : std::filesystem::path(location.file).parent_path();
  std::string path = files_.absolute(folder / name);
  const std::string& trouble = files_.trouble(path);
  if (!trouble.empty()) refuse(fmt::format("{}: {}", trouble, path));
  return path;
}

void ValueReader::read(const YamlNode& node, const Entry& entry, const std::string& path,
                       Teuchos::ParameterList& list) {
  if (entry.kind == Kind::reals || entry.kind == Kind::integers || entry.kind == Kind::texts) {
    read_list(node, entry, path, list);
    return;
  }
  try {
    switch (entry.kind) {
      case Kind::real:
        list.set(entry.key, real(node, entry));
        break;
      case Kind::integer:
        list.set(entry.key, integer(node, entry));
        break;
      case Kind::flag:
        list.set(entry.key, flag(node));
        break;
      case Kind::text:
        if (node.kind != YamlNode::Kind::scalar) refuse(what_is_given(node));
        list.set(entry.key, node.text);
        break;
      case Kind::choice:
        list.set(entry.key, choice(node, entry));
        break;
      case Kind::file:
        require_scalar(node);
        list.set(entry.key, file(node.text, node.location), names_data_file);
        break;
      default:
        throw std::logic_error(fmt::format("the key '{}' holds no value", entry.key));
    }
  } catch (const InputError& error) {
    mistakes_.add(node.location, at(path, error, entry));
  }
}

void ValueReader::read_list(const YamlNode& node, const Entry& entry, const std::string& path,
                            Teuchos::ParameterList& list) {
  const std::size_t before = mistakes_.count();
  if (node.kind != YamlNode::Kind::list) {
    const bool one_value = node.kind == YamlNode::Kind::scalar && entry.length < 2;
    mistakes_.add(node.location,
                  {path, what_is_given(node), expectation(entry), one_value ? fmt::format("[{}]", node.text) : ""});
    return;
  }
  if (entry.length != 0 && node.items.size() != static_cast<std::size_t>(entry.length)) {
    mistakes_.add(node.location,
                  {path, fmt::format("a list of {} is given", node.items.size()), expectation(entry), {}});
  }
  Teuchos::Array<double> reals;
  Teuchos::Array<int> integers;
  Teuchos::Array<std::string> texts;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    try {
      if (entry.kind == Kind::reals) {
        reals.push_back(real(item, entry));
      } else if (entry.kind == Kind::integers) {
        integers.push_back(integer(item, entry));
      } else {
        require_scalar(item);
        texts.push_back(item.text);
      }
    } catch (const InputError& error) {
      mistakes_.add(item.location, at(fmt::format("{}.{}", path, i), error, entry));
    }
  }
  if (mistakes_.count() != before) return;
  if (entry.kind == Kind::reals) list.set(entry.key, reals);
  if (entry.kind == Kind::integers) list.set(entry.key, integers);
  if (entry.kind == Kind::texts) list.set(entry.key, texts);
}

void ValueReader::set_default(const Entry& entry, const std::string& path, const Location& location,
                              Teuchos::ParameterList& list) {
  const Entry::Value& value = entry.fallback;
  const auto* integer_value = std::get_if<int>(&value);
  const auto* text_value = std::get_if<std::string>(&value);
  switch (entry.kind) {
    case Kind::real:
      // `defaults_to(1)` holds an int.
      if (integer_value != nullptr) return void(list.set(entry.key, static_cast<double>(*integer_value)));
      if (const auto* real_value = std::get_if<double>(&value)) return void(list.set(entry.key, *real_value));
      break;
    case Kind::integer:
      if (integer_value != nullptr) return void(list.set(entry.key, *integer_value));
      break;
    case Kind::flag:
      if (const auto* flag_value = std::get_if<bool>(&value)) return void(list.set(entry.key, *flag_value));
      break;
    case Kind::text:
    case Kind::choice:
      if (text_value != nullptr) return void(list.set(entry.key, *text_value));
      break;
    case Kind::file:
      if (text_value == nullptr) break;
      try {
        list.set(entry.key, file(*text_value, {}), names_data_file);
      } catch (const InputError& error) {
        mistakes_.add(location, at(path, error, entry));
      }
      return;
    case Kind::reals:
      if (const auto* numbers = std::get_if<std::vector<int>>(&value)) {
        return void(list.set(entry.key, Teuchos::Array<double>(as_doubles(*numbers))));
      }
      if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        return void(list.set(entry.key, Teuchos::Array<double>(*numbers)));
      }
      break;
    case Kind::integers:
      if (const auto* numbers = std::get_if<std::vector<int>>(&value)) {
        return void(list.set(entry.key, Teuchos::Array<int>(*numbers)));
      }
      break;
    case Kind::texts:
      if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
        return void(list.set(entry.key, Teuchos::Array<std::string>(*texts)));
      }
      break;
    default:
      break;
  }
  throw_wrong_default(entry);
}

}  // namespace kiln
