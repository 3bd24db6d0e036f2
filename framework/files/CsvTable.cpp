#include "framework/files/CsvTable.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "framework/base/Error.hpp"
#include "framework/input/Mistakes.hpp"

namespace kiln {
namespace {

/// Longer lines are no lines of a table: a run's has a cell for each probe and component.
constexpr std::size_t longest_line = std::size_t{1} << 20;

/// Cells of one line; quotes as in RFC 4180, without line breaks inside them.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) cells.back() += line[i++];
      if (!doubled) quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      cells.emplace_back();
    } else if (line[i] != '\r') {
      cells.back() += line[i];
    }
  }
  return cells;
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path);
  if (!file) throw FileError(path.string(), "", std::string("cannot be read: ") + std::strerror(errno));
  CsvTable table;
  std::string line;
  if (!std::getline(file, line)) throw FileError(path.string(), "", "is empty", "a header row and rows of numbers");
  const auto check_length = [&](int number) {
    if (line.size() <= longest_line) return;
    throw FileError(path.string(), fmt::format("line {}", number), fmt::format("has {} characters", line.size()),
                    "a row of a table, separated by commas");
  };
  check_length(1);
  table.columns = cells_of(line);
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    check_length(number);
    const std::vector<std::string> cells = cells_of(line);
    const std::string place = fmt::format("line {}", number);
    if (cells.size() != table.columns.size()) {
      throw FileError(path.string(), place, fmt::format("has {} cells", cells.size()),
                      fmt::format("{}, as the header has", table.columns.size()));
    }
    std::vector<double>& row = table.rows.emplace_back();
    for (const std::string& cell : cells) {
      double value = 0.0;
      const char* end = cell.data() + cell.size();
      const auto [stop, error] = std::from_chars(cell.data(), end, value);
      if (error != std::errc() || stop != end) {
        throw FileError(path.string(), place, fmt::format("{} is no number", in_quotes(cell)), "a number");
      }
      row.push_back(value);
    }
  }
  return table;
}

}  // namespace kiln
