#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "framework/base/ExchangeInterval.hpp"
#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A CSV file that grows by a row at a time: one header row, then rows of the step, the time in s and numbers that read
/// back to the same bits. Every rank knows a part of a row; the ranks hand over their parts about four times a second
/// (ExchangeInterval) and on flush(), and rank 0 joins and writes them.
class CsvLog {
 public:
  /// Fills in a row's numbers, as many as columns after step and time, from the parts of all ranks; on rank 0.
  using Join = std::function<void(const std::vector<const double*>& parts, std::vector<double>& numbers)>;

  /// `columns`: those of step and time come first. Starts a new file, or with `first_step` above 0 continues one,
  /// without its rows of later steps. `part`: how many numbers a rank gives. Throws FileError; also when an existing
  /// file has another header. Collective.
  CsvLog(std::filesystem::path path, const std::vector<std::string>& columns, int first_step, std::size_t part,
         Join join, Teuchos::RCP<const Communicator> communicator);

  /// Throws FileError when the disk refuses. Collective.
  void add(int step, double time, const std::vector<double>& part);
  /// All rows so far reach the operating system. Throws FileError when one does not. Collective.
  void flush();

 private:
  void write(const std::vector<double>& records);

  std::filesystem::path path_;
  Teuchos::RCP<const Communicator> communicator_;
  Join join_;
  std::size_t numbers_;  ///< of a row, after step and time
  std::size_t record_;   ///< numbers a rank keeps of a row: step, time and its part
  ExchangeInterval interval_;
  std::vector<double> kept_;  ///< this rank's records since the last exchange
  std::ofstream file_;        ///< on rank 0
};

/// A CSV cell, in quotes where it needs them (RFC 4180).
std::string csv_cell(const std::string& text);

}  // namespace kiln
