#include "framework/input/Mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "framework/base/Text.hpp"

namespace kiln {

std::string to_string(const Location& location) {
  const std::string file = printable(location.file);
  return location.line == 0 ? file : fmt::format("{}:{}:{}", file, location.line, location.column);
}

void Mistakes::add(const Location& location, Problem problem) { mistakes_.push_back({location, std::move(problem)}); }

InputError Mistakes::error() const {
  const auto position = [this](const Mistake& mistake) {
    const auto file = std::find(files_.begin(), files_.end(), mistake.location.file) - files_.begin();
    return std::make_tuple(file, mistake.location.line, mistake.location.column);
  };
  std::vector<Mistake> sorted = mistakes_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Mistake& a, const Mistake& b) { return position(a) < position(b); });
  std::vector<Problem> problems;
  std::set<std::pair<std::string, std::string>> told;
  for (Mistake& mistake : sorted) {
    std::string& path = mistake.problem.path;
    const std::string place = to_string(mistake.location);
    path = path.empty() ? place : fmt::format("{}: {}", place, path);
    // A file that is included twice tells its mistakes once.
    if (told.emplace(path, mistake.problem.found).second) problems.push_back(std::move(mistake.problem));
  }
  if (problems.size() > most_told) {
    const std::string file = files_.empty() ? "" : files_.front();
    const Problem rest{file, fmt::format("{} more mistakes", problems.size() - most_told), {}, {}};
    problems.resize(most_told);
    problems.push_back(rest);
  }
  return InputError(std::move(problems));
}

}  // namespace kiln
