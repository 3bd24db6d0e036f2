#include "framework/base/Error.hpp"

#include <fmt/format.h>

namespace kiln {
namespace {

std::string text(const Problem& problem) {
  std::string line = problem.path.empty() ? problem.found : fmt::format("{}: {}", problem.path, problem.found);
  if (!problem.expected.empty()) line += fmt::format("; expected {}", problem.expected);
  if (!problem.suggestion.empty()) line += fmt::format("; did you mean '{}'?", problem.suggestion);
  return line;
}

std::string text(const std::vector<Problem>& problems) {
  std::string lines;
  for (const Problem& problem : problems) lines += (lines.empty() ? "" : "\n") + text(problem);
  return lines;
}

std::string file_text(const std::string& file, const std::string& place, const std::string& found,
                      const std::string& expected) {
  std::string line = place.empty() ? fmt::format("{}: {}", file, found) : fmt::format("{}: {}: {}", file, place, found);
  if (!expected.empty()) line += fmt::format("; expected {}", expected);
  return line;
}

}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(text(problems)), problems_(std::move(problems)) {}

InputError::InputError(std::string path, std::string found, std::string expected, std::string suggestion)
    : InputError(
          std::vector<Problem>{{std::move(path), std::move(found), std::move(expected), std::move(suggestion)}}) {}

FileError::FileError(std::string file, std::string place, std::string found, std::string expected)
    : std::runtime_error(file_text(file, place, found, expected)) {}

NotOffered::NotOffered(std::string_view class_name, std::string_view method, std::string_view instead)
    : std::logic_error(instead.empty() ? fmt::format("{} does not offer {}", class_name, method)
                                       : fmt::format("{} does not offer {}; {}", class_name, method, instead)) {}

DivergenceError::DivergenceError(std::string what, int step, double time)
    : std::runtime_error(fmt::format("step {}, t = {:.6g} s: {}", step, time, what)) {}

DivergenceError::DivergenceError(std::string what, int step, double time, long long particle,
                                 std::array<double, 3> position)
    : std::runtime_error(fmt::format("step {}, t = {:.6g} s, particle {} at ({:.6g}, {:.6g}, {:.6g}) m: {}", step, time,
                                     particle, position[0], position[1], position[2], what)) {}

}  // namespace kiln
