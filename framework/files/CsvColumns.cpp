#include "framework/files/CsvColumns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>

#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"
#include "framework/input/Mistakes.hpp"

namespace kiln {
namespace {

/// Longer lines are no lines of a table.
constexpr std::size_t longest_line = 4096;

std::string_view trimmed(std::string_view text) {
  const char* blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0;;) {
    const std::size_t comma = line.find(',', at);
    cells.push_back(trimmed(line.substr(at, comma == std::string_view::npos ? comma : comma - at)));
    if (comma == std::string_view::npos) return cells;
    at = comma + 1;
  }
}

std::string text_of(const std::string& file, const Communicator& communicator) {
  std::string text;
  on_root(communicator, file, [&]() -> std::optional<Fault> {
    std::ifstream stream(file);
    std::ostringstream content;
    if (!stream) return system_fault("opened", errno);
    content << stream.rdbuf();
    if (stream.bad()) return system_fault("read", errno);
    text = content.str();
    return std::nullopt;
  });
  return broadcast(communicator, text);
}

double number(std::string_view cell, const std::string& file, int line, const std::string& column) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
    throw FileError(file, fmt::format("line {}, column '{}'", line, column),
                    cell.empty() ? "is empty" : fmt::format("{} is not a finite number", in_quotes(std::string(cell))),
                    "a number in SI units");
  }
  return value;
}

}  // namespace

int CsvColumns::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

CsvColumns read_csv_columns(const std::string& file, const std::vector<std::string>& required,
                            const std::vector<std::string>& optional, const Communicator& communicator) {
  const std::string text = text_of(file, communicator);
  CsvColumns csv;
  int line = 0;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view content = trimmed(std::string_view(text).substr(at, end - at));
    at = end + 1;
    if (content.size() > longest_line) {
      throw FileError(file, fmt::format("line {}", line + 1), fmt::format("has {} characters", content.size()),
                      "a row of a table, separated by commas");
    }
    if (content.empty() || content.front() == '#') continue;
    const std::vector<std::string_view> cells = split(content);
    const std::string place = fmt::format("line {}", line + 1);
    if (csv.columns.empty()) {
      for (const std::string_view cell : cells) {
        const std::string name(cell);
        const bool known = std::count(required.begin(), required.end(), name) != 0 ||
                           std::count(optional.begin(), optional.end(), name) != 0;
        if (!known || csv.find(name) >= 0) {
          throw FileError(file, place,
                          fmt::format("column {} is {}", in_quotes(name), known ? "there twice" : "not known"),
                          fmt::format("a first line with the columns {}{}{}", fmt::join(required, ", "),
                                      optional.empty() ? "" : " and, as wanted, ", fmt::join(optional, ", ")));
        }
        csv.columns.push_back(name);
      }
      for (const std::string& name : required) {
        if (csv.find(name) < 0) throw FileError(file, place, fmt::format("column '{}' is missing", name));
      }
      csv.values.resize(csv.columns.size());
      continue;
    }
    if (cells.size() != csv.columns.size()) {
      throw FileError(file, place, fmt::format("{} values", cells.size()), fmt::format("{}", csv.columns.size()));
    }
    for (std::size_t column = 0; column < cells.size(); ++column) {
      csv.values[column].push_back(number(cells[column], file, line + 1, csv.columns[column]));
    }
    csv.lines.push_back(line + 1);
  }
  if (csv.lines.empty()) throw FileError(file, "", "has no line of numbers");
  return csv;
}

}  // namespace kiln
