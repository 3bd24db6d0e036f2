#include "framework/registry/Describe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "framework/base/Nearest.hpp"
#include "framework/base/Text.hpp"
#include "framework/registry/EntryText.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

using Kind = Entry::Kind;
template <std::size_t columns>
using Table = std::vector<std::array<std::string, columns>>;

/// Number of characters, not bytes.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Columns two spaces apart; the last one is as long as its text. Every line begins with `indent`.
template <std::size_t columns>
std::string aligned(const Table<columns>& table, const std::string& indent) {
  std::array<std::size_t, columns> widths{};
  for (const auto& row : table) {
    for (std::size_t i = 0; i < columns; ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string text;
  for (const auto& row : table) {
    std::string line = indent;
    for (std::size_t i = 0; i < columns; ++i) line += row[i] + std::string(widths[i] - width(row[i]) + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string origin(const Registration& registration) {
  return registration.library.empty() ? "built in" : registration.library;
}

void add_rows(const Specification& specification, const std::string& indent, Table<6>& table) {
  for (const auto& entry : specification.entries()) {
    const bool has_unit = entry->kind == Kind::real || entry->kind == Kind::reals;
    const bool blocks = entry->kind == Kind::blocks;
    table.push_back({indent + (blocks ? "<name>" : entry->key), type_text(*entry), has_unit ? entry->unit : "",
                     default_column(*entry), fmt::format("{}", fmt::join(values_column(*entry), " | ")), entry->help});
    if (entry->nested) add_rows(*entry->nested, indent + "  ", table);
  }
}

std::string keys_table(const Specification& specification) {
  Table<6> table = {{"key", "type", "unit", "default", "values", ""}};
  add_rows(specification, "", table);
  return table.size() == 1 ? "  no keys\n" : aligned<6>(table, "  ");
}

std::string describe_category(const std::string& category) {
  Table<2> members;
  for (const Registration* registration : catalogue::all()) {
    if (registration->category == category) members.push_back({registration->name, registration->summary});
  }
  return fmt::format("{}: a kind of component\n", category) + aligned<2>(members, "  ");
}

}  // namespace

std::string list_components() {
  Table<4> table = {{"category", "name", "summary", "from"}};
  for (const Registration* registration : catalogue::all()) {
    table.push_back({registration->category, registration->name, registration->summary, origin(*registration)});
  }
  return aligned<4>(table, "");
}

std::string describe(const Specification& specification, const std::string& title) {
  return title + "\n" + keys_table(specification);
}

std::string describe(const std::string& name) {
  std::string text;
  std::vector<std::string> known;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "\n") + part; };
  for (const Registration* registration : catalogue::all()) {
    known.push_back(registration->name);
    if (std::find(known.begin(), known.end(), registration->category) == known.end()) {
      known.push_back(registration->category);
      if (registration->category == name) add(describe_category(name));
    }
    if (registration->name != name) continue;
    const std::string from = registration->library.empty() ? "" : ", from " + registration->library;
    add(describe(registration->specification(),
                 fmt::format("{} ({}{}): {}", name, registration->category, from, registration->summary)));
  }
  if (text.empty()) {
    throw InputError("", fmt::format("there is no component or category {}", in_quotes(name)),
                     "a name that `kiln list` shows", nearest(name, known));
  }
  return text;
}

}  // namespace kiln
