#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A CSV file that grows by a row at a time, written by rank 0: one header row, numbers that read back to the same
/// bits. Its first column is the step. Rows reach the operating system within half a second, and on flush().
class CsvLog {
 public:
  /// Starts a new file, or with `first_step` above 0 continues one, without its rows of later steps. Throws FileError;
  /// also when an existing file has another header. Collective.
  CsvLog(std::filesystem::path path, const std::vector<std::string>& columns, int first_step,
         Teuchos::RCP<const Communicator> communicator);

  /// Rank 0's numbers are written, one for each column after the first. Throws FileError when the disk refuses; it is
  /// looked at every 256 rows. Collective.
  void add(int step, const std::vector<double>& values);
  /// Throws FileError when a row did not reach the disk. Collective.
  void check();
  void flush();
  std::size_t rows() const { return rows_; }

 private:
  std::filesystem::path path_;
  Teuchos::RCP<const Communicator> communicator_;
  std::ofstream file_;
  std::string row_;
  std::chrono::steady_clock::time_point flushed_;
  std::size_t rows_ = 0;
};

/// A CSV cell, in quotes where it needs them (RFC 4180).
std::string csv_cell(const std::string& text);

}  // namespace kiln
