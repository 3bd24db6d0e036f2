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
#include "framework/base/Text.hpp"
#include "framework/files/CsvRows.hpp"
#include "framework/files/Together.hpp"

namespace kiln {
namespace {

/// Longer lines are no lines of a table.
constexpr std::size_t longest_line = 4096;

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

/// The first line: the columns of the file.
void read_header(const std::string& file, const std::string& place, const std::vector<std::string>& cells,
                 const std::vector<std::string>& required, const std::vector<std::string>& optional, CsvColumns& csv) {
  for (const std::string& name : cells) {
    const bool known = std::count(required.begin(), required.end(), name) != 0 ||
                       std::count(optional.begin(), optional.end(), name) != 0;
    if (!known || csv.find(name) >= 0) {
      throw FileError(file, place, fmt::format("column {} is {}", in_quotes(name), known ? "there twice" : "not known"),
                      fmt::format("a first line with the columns {}{}{}", fmt::join(required, ", "),
                                  optional.empty() ? "" : " and, as wanted, ", fmt::join(optional, ", ")));
    }
    csv.columns.push_back(name);
  }
  for (const std::string& name : required) {
    if (csv.find(name) < 0) throw FileError(file, place, fmt::format("column '{}' is missing", name));
  }
  csv.values.resize(csv.columns.size());
}

}  // namespace

int CsvColumns::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

CsvColumns read_csv_columns(const std::string& file, const std::vector<std::string>& required,
                            const std::vector<std::string>& optional, const Communicator& communicator) {
  CsvColumns csv;
  for_each_csv_row(
      file, text_of(file, communicator), longest_line, [&](int line, const std::vector<std::string>& cells) {
        const std::string place = fmt::format("line {}", line);
        if (csv.columns.empty()) return read_header(file, place, cells, required, optional, csv);
        if (cells.size() != csv.columns.size()) {
          throw FileError(file, place, fmt::format("{} values", cells.size()), fmt::format("{}", csv.columns.size()));
        }
        for (std::size_t column = 0; column < cells.size(); ++column) {
          csv.values[column].push_back(number(cells[column], file, line, csv.columns[column]));
        }
        csv.lines.push_back(line);
      });
  if (csv.lines.empty()) throw FileError(file, "", "has no line of numbers");
  return csv;
}

}  // namespace kiln
