#include "framework/files/CsvTable.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

#include "framework/base/Error.hpp"
#include "framework/base/Text.hpp"
#include "framework/files/CsvRows.hpp"

namespace kiln {
namespace {

/// A run's line has a cell for each probe and component.
constexpr std::size_t longest_line = std::size_t{1} << 20;

std::string text_of(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path);
  if (!file) throw FileError(path.string(), "", std::string("cannot be read: ") + std::strerror(errno));
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) throw FileError(path.string(), "", "cannot be read to its end");
  return text.str();
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& path) {
  CsvTable table;
  for_each_csv_row(path.string(), text_of(path), longest_line, [&](int line, const std::vector<std::string>& cells) {
    if (table.columns.empty()) {
      table.columns = cells;
      return;
    }
    const std::string place = fmt::format("line {}", line);
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
  });
  if (table.columns.empty()) throw FileError(path.string(), "", "is empty", "a header row and rows of numbers");
  return table;
}

}  // namespace kiln
