#include "framework/files/CsvLog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <sstream>
#include <utility>

#include "framework/files/AtomicFile.hpp"
#include "framework/files/Together.hpp"
#include "framework/input/Mistakes.hpp"

namespace kiln {
namespace {

constexpr std::chrono::milliseconds flush_interval(500);

std::string header_of(const std::vector<std::string>& columns) {
  std::string header;
  for (const std::string& column : columns) header += (header.empty() ? "" : ",") + csv_cell(column);
  return header;
}

/// The header and the rows up to `last_step` of an existing file.
std::optional<Fault> read_kept(const std::filesystem::path& path, const std::string& header, std::size_t columns,
                               int last_step, std::string& kept) {
  errno = 0;
  std::ifstream file(path);
  if (!file) return system_fault("read", errno);
  std::string line;
  std::getline(file, line);
  if (line != header) return Fault{"line 1", "has the columns " + shown(line), header};
  kept = header + "\n";
  for (int number = 2; std::getline(file, line); ++number) {
    // A row without its end was being written when the program was killed.
    if (file.eof()) break;
    int step = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), step);
    if (error != std::errc() || end == line.data() + line.size() || *end != ',') {
      return Fault{fmt::format("line {}", number), "does not begin with a step: " + shown(line), "a row of numbers"};
    }
    const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (commas + 1 != columns) {
      return Fault{fmt::format("line {}", number), fmt::format("has {} cells", commas + 1), fmt::format("{}", columns)};
    }
    if (step <= last_step) kept += line + "\n";
  }
  return std::nullopt;
}

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

CsvLog::CsvLog(std::filesystem::path path, const std::vector<std::string>& columns, int first_step,
               Teuchos::RCP<const Communicator> communicator)
    : path_(std::move(path)), communicator_(std::move(communicator)) {
  const std::string header = header_of(columns);
  std::string kept = header + "\n";
  if (first_step > 0) {
    on_root(*communicator_, path_.string(), [&] { return read_kept(path_, header, columns.size(), first_step, kept); });
  }
  write_atomically(path_, kept, communicator_);
  on_root(*communicator_, path_.string(), [this]() -> std::optional<Fault> {
    errno = 0;
    file_.open(path_, std::ios::app);
    if (!file_) return system_fault("written", errno);
    return std::nullopt;
  });
}

void CsvLog::add(int step, const std::vector<double>& values) {
  if (communicator_->getRank() == 0) {
    row_ = std::to_string(step);
    for (const double value : values) fmt::format_to(std::back_inserter(row_), ",{}", value);
    row_ += '\n';
    file_ << row_;
    if (std::chrono::steady_clock::now() - flushed_ > flush_interval) flush();
  }
  if (++rows_ % 256 == 0) check();
}

void CsvLog::flush() {
  if (communicator_->getRank() != 0) return;
  file_.flush();
  flushed_ = std::chrono::steady_clock::now();
}

void CsvLog::check() {
  flush();
  throw_together(
      *communicator_, path_.string(),
      file_.fail() ? std::optional<Fault>(Fault{"", "cannot be written", "room on the disk"}) : std::nullopt);
}

}  // namespace kiln
