#include "framework/files/CsvRows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

constexpr std::string_view blanks = " \t\r";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The text of a cell that begins at `at` with a quote; `at` goes to what follows the closing one. Nothing: none
/// closes.
std::optional<std::string> quoted(std::string_view line, std::size_t& at) {
  std::string cell;
  for (++at; at < line.size(); ++at) {
    if (line[at] == '"') {
      ++at;
      const bool is_doubled = at < line.size() && line[at] == '"';
      if (!is_doubled) return cell;
    }
    cell += line[at];
  }
  return std::nullopt;
}

/// Returns what is wrong with the line; empty: nothing.
const char* split(std::string_view line, std::vector<std::string>& cells) {
  cells.clear();
  for (std::size_t at = 0;;) {
    at = std::min(line.find_first_not_of(blanks, at), line.size());
    const bool has_quotes = at < line.size() && line[at] == '"';
    std::optional<std::string> cell;
    if (has_quotes && !(cell = quoted(line, at))) return "has a quote that nothing closes";
    const std::size_t comma = std::min(line.find(',', at), line.size());
    const std::string_view rest = trimmed(line.substr(at, comma - at));
    if (has_quotes && !rest.empty()) return "has text behind a closing quote";
    cells.push_back(cell ? std::move(*cell) : std::string(rest));
    if (comma == line.size()) return "";
    at = comma + 1;
  }
}

}  // namespace

void for_each_csv_row(const std::string& file, std::string_view text, std::size_t longest,
                      const std::function<void(int line, const std::vector<std::string>& cells)>& row) {
  if (text.substr(0, byte_order_mark.size()) == byte_order_mark) text.remove_prefix(byte_order_mark.size());
  std::vector<std::string> cells;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.size() > longest) {
      throw FileError(file, fmt::format("line {}", number), fmt::format("has {} characters", line.size()),
                      "a row of a table, separated by commas");
    }
    if (line.empty() || line.front() == '#') continue;
    if (const std::string trouble = split(line, cells); !trouble.empty()) {
      throw FileError(file, fmt::format("line {}", number), trouble, "cells between commas, whole ones in quotes");
    }
    row(number, cells);
  }
}

}  // namespace kiln
