#include "framework/driver/StudyProgress.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "framework/observers/ProgressObserver.hpp"

namespace kiln {
namespace {

std::string left_text(std::optional<double> left) {
  return left ? fmt::format(", {} left", duration_text(*left)) : std::string();
}

}  // namespace

std::string short_duration(double seconds) {
  return seconds < 59.95 ? fmt::format("{:.{}f} s", seconds, seconds < 1.0 ? 2 : 1) : duration_text(seconds);
}

void CaseTimes::add(const std::vector<std::string>& kind, double seconds) {
  for (std::size_t words = 0; words <= kind.size(); ++words) {
    Sum& sum = sums_[{kind.begin(), kind.begin() + static_cast<std::ptrdiff_t>(words)}];
    sum.seconds += seconds;
    ++sum.count;
  }
}

std::optional<double> CaseTimes::expected(const std::vector<std::string>& kind) const {
  for (std::vector<std::string> words = kind;; words.pop_back()) {
    if (const auto sum = sums_.find(words); sum != sums_.end()) return sum->second.seconds / sum->second.count;
    if (words.empty()) return std::nullopt;
  }
}

StudyProgress::StudyProgress(std::vector<std::string> names, std::FILE* stream, bool terminal)
    : names_(std::move(names)), stream_(stream), terminal_(terminal) {
  for (const std::string& name : names_) width_ = std::max(width_, name.size());
}

std::string StudyProgress::label(std::size_t index) const {
  const std::string count = std::to_string(names_.size());
  return fmt::format("[{:{}}/{}] {:{}}", index + 1, count.size(), count, names_[index], width_);
}

void StudyProgress::begin(std::size_t index, std::optional<double> left) {
  if (stream_ == nullptr || !terminal_) return;
  fmt::print(stream_, "\r{}           running{}\x1b[K", label(index), left_text(left));
  std::fflush(stream_);
}

void StudyProgress::end(std::size_t index, std::optional<double> seconds, const std::string& outcome,
                        std::optional<double> left) {
  if (stream_ == nullptr) return;
  if (terminal_) fmt::print(stream_, "\r\x1b[K");
  fmt::print(stream_, "{} {:>8}  {}{}\n", label(index), seconds ? short_duration(*seconds) : "", outcome,
             left_text(left));
  std::fflush(stream_);
}

}  // namespace kiln
