#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// A CSV file of numbers below one header row.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

/// Reads a table as CsvLog, pandas and spreadsheets write them (for_each_csv_row()); "nan" and "inf" are numbers.
/// Throws FileError that names the line for a missing file, a row of another length or a cell that is no number. Not
/// collective.
CsvTable read_csv(const std::filesystem::path& path);

}  // namespace kiln
