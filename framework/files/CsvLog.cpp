#include "framework/files/CsvLog.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "framework/base/Text.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Together.hpp"

namespace kiln {
namespace {

/// Rows after which ranks exchange in any case, for memory's sake.
constexpr std::size_t most_rows = 4096;

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

CsvLog::CsvLog(std::filesystem::path path, const std::vector<std::string>& columns, int first_step, std::size_t part,
               Join join, Teuchos::RCP<const Communicator> communicator)
    : path_(std::move(path)),
      communicator_(std::move(communicator)),
      join_(std::move(join)),
      numbers_(columns.size() - 2),
      record_(2 + part),
      interval_(first_step) {
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

void CsvLog::add(int step, double time, const std::vector<double>& part) {
  if (part.size() + 2 != record_) {
    throw std::logic_error(fmt::format("CsvLog: a part of {} numbers; expected {}", part.size(), record_ - 2));
  }
  kept_.push_back(step);
  kept_.push_back(time);
  kept_.insert(kept_.end(), part.begin(), part.end());
  if (!interval_.due(step) && kept_.size() < most_rows * record_) return;
  flush();
  const int mine = interval_.steps_to_come(step);
  int least = mine;
  Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_MIN, 1, &mine, &least);
  interval_.exchanged(step, least);
}

void CsvLog::flush() {
  const int ranks = communicator_->getSize();
  if (ranks == 1) {
    write(kept_);
  } else {
    const bool writes = communicator_->getRank() == 0;
    std::vector<double> all(writes ? kept_.size() * ranks : 0);
    const auto count = static_cast<int>(kept_.size());
    Teuchos::gather(kept_.data(), count, all.data(), count, 0, *communicator_);
    if (writes) write(all);
  }
  kept_.clear();
  file_.flush();
  throw_together(
      *communicator_, path_.string(),
      file_.fail() ? std::optional<Fault>(Fault{"", "cannot be written", "room on the disk"}) : std::nullopt);
}

void CsvLog::write(const std::vector<double>& records) {
  std::vector<const double*> parts(communicator_->getSize());
  std::vector<double> numbers(numbers_);
  std::string text;
  for (std::size_t at = 0; at < kept_.size(); at += record_) {
    for (std::size_t rank = 0; rank < parts.size(); ++rank) parts[rank] = &records[rank * kept_.size() + at] + 2;
    join_(parts, numbers);
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{},{}"), static_cast<int>(kept_[at]), kept_[at + 1]);
    for (const double number : numbers) fmt::format_to(std::back_inserter(text), FMT_COMPILE(",{}"), number);
    text += '\n';
  }
  file_ << text;
}

}  // namespace kiln
