#pragma once

#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Numbers of a comma-separated file whose first line names the columns (for_each_csv_row()).
struct CsvColumns {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  ///< one vector a column
  std::vector<int> lines;                   ///< line of each row in the file, 1-based

  /// Index of a column, -1: absent.
  int find(const std::string& column) const;
};

/// Reads the file on rank 0 for all. Every column must be one of `required` or `optional`, every value a finite number.
/// Throws FileError that names the line. Collective.
CsvColumns read_csv_columns(const std::string& file, const std::vector<std::string>& required,
                            const std::vector<std::string>& optional, const Communicator& communicator);

}  // namespace kiln
