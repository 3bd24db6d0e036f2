#include "framework/registry/EntryText.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/emitter.h>

#include <algorithm>

#include "framework/base/Units.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

using Kind = Entry::Kind;

std::string after(const std::string& text, const std::string& more) { return more.empty() ? text : text + " " + more; }

/// "numbers in m", "integers", "texts".
std::string elements(const Entry& entry) {
  if (entry.kind == Kind::reals) return entry.unit == "1" ? "numbers" : "numbers in " + entry.unit;
  return entry.kind == Kind::integers ? "integers" : "texts";
}

std::string list_expectation(const Entry& entry) {
  const std::string count = entry.length == 0 ? "" : fmt::format("{} ", entry.length);
  const std::string range = range_text(entry);
  return fmt::format("a list of {}{}{}", count, elements(entry), range.empty() ? "" : ", each " + range);
}

std::vector<std::string> keys_of(const Specification& specification) {
  std::vector<std::string> keys;
  for (const auto& entry : specification.entries()) {
    if (entry->kind != Kind::blocks) keys.push_back(entry->key);
  }
  return keys;
}

std::string known_types(const Entry& entry) {
  const std::vector<std::string> names = catalogue::names(entry.category);
  return names.empty() ? "none is registered" : fmt::format("one of: {}", fmt::join(names, ", "));
}

struct DefaultText {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(double value) const { return fmt::format("{}", value); }
  std::string operator()(int value) const { return fmt::format("{}", value); }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& value) const { return yaml_text(value); }
  template <class T>
  std::string operator()(const std::vector<T>& values) const {
    std::vector<std::string> texts;
    for (const T& value : values) texts.push_back((*this)(value));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }
};

}  // namespace

std::string bound_text(double bound, const Entry& entry) {
  return entry.unit == "1" || bound == 0 ? fmt::format("{}", bound) : fmt::format("{} {}", bound, entry.unit);
}

std::string range_text(const Entry& entry) {
  if (entry.lower && entry.upper && !entry.open_lower && !entry.open_upper) {
    return fmt::format("from {} to {}", bound_text(*entry.lower, entry), bound_text(*entry.upper, entry));
  }
  std::string lower, upper;
  if (entry.lower) {
    lower = fmt::format("{} {}", entry.open_lower ? "above" : "at least", bound_text(*entry.lower, entry));
  }
  if (entry.upper) {
    upper = fmt::format("{} {}", entry.open_upper ? "below" : "at most", bound_text(*entry.upper, entry));
  }
  return lower.empty() || upper.empty() ? lower + upper : lower + " and " + upper;
}

std::string expectation(const Entry& entry) {
  switch (entry.kind) {
    case Kind::real: {
      const std::string unit = entry.unit == "1" ? "" : " in " + entry.unit;
      return after(with_article(parse_unit(entry.unit).dimension) + unit, range_text(entry));
    }
    case Kind::integer:
      return after("an integer", range_text(entry));
    case Kind::flag:
      return "true or false";
    case Kind::text:
      return "a text";
    case Kind::choice:
      return fmt::format("one of: {}", fmt::join(entry.choices, ", "));
    case Kind::file:
      return "an existing file";
    case Kind::reals:
    case Kind::integers:
    case Kind::texts:
      return list_expectation(entry);
    case Kind::dictionary:
      return "a block of keys, each with a text or a list of texts";
    case Kind::section:
      return fmt::format("a block with the keys: {}", fmt::join(keys_of(*entry.nested), ", "));
    case Kind::sections:
      return fmt::format("a list of blocks with the keys: {}", fmt::join(keys_of(*entry.nested), ", "));
    case Kind::component:
      return fmt::format("a {}, {}", entry.category, known_types(entry));
    case Kind::components:
      return fmt::format("a list, each item a {}, {}", entry.category, known_types(entry));
    case Kind::blocks:
      return fmt::format("a block of a {}", entry.category);
  }
  throw std::logic_error("an entry without a kind: " + entry.key);
}

std::string type_text(const Entry& entry) {
  const std::string count = entry.length == 0 ? "" : fmt::format("{} ", entry.length);
  switch (entry.kind) {
    case Kind::real:
      return "number";
    case Kind::integer:
      return "integer";
    case Kind::flag:
      return "true/false";
    case Kind::text:
      return "text";
    case Kind::choice:
      return "choice";
    case Kind::file:
      return "file";
    case Kind::reals:
      return count + "numbers";
    case Kind::integers:
      return count + "integers";
    case Kind::texts:
      return count + "texts";
    case Kind::dictionary:
      return "block of texts";
    case Kind::section:
      return "block";
    case Kind::sections:
      return "list of blocks";
    case Kind::component:
      return entry.category;
    case Kind::components:
      return fmt::format("list: {}", entry.category);
    case Kind::blocks:
      return fmt::format("blocks: {}", entry.category);
  }
  throw std::logic_error("an entry without a kind: " + entry.key);
}

std::string default_text(const Entry& entry) { return std::visit(DefaultText(), entry.fallback); }

std::string default_column(const Entry& entry) {
  if (entry.kind == Kind::blocks) return "optional";
  if (entry.fallback.index() != 0) return default_text(entry);
  return entry.required ? "required" : "optional";
}

std::vector<std::string> values_column(const Entry& entry) {
  if (entry.kind == Kind::choice) return entry.choices;
  if (entry.kind == Kind::component || entry.kind == Kind::components || entry.kind == Kind::blocks) {
    return catalogue::names(entry.category);
  }
  const std::string range = range_text(entry);
  return range.empty() ? std::vector<std::string>() : std::vector<std::string>{range};
}

std::string yaml_text(const std::string& text) {
  YAML::Emitter emitter;
  // As inside a list in brackets, where more characters need quotes.
  emitter << YAML::Flow << YAML::BeginSeq << text << YAML::EndSeq;
  const std::string list = emitter.c_str();
  return list.substr(1, list.size() - 2);
}

std::string block_key(const std::string& name) {
  std::string key = name;
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

}  // namespace kiln
