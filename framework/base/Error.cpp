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

std::string divergence_text(const std::string& what, const std::optional<int>& step, double time,
                            const std::optional<DivergenceError::Place>& place) {
  std::string line = step ? fmt::format("step {}, t = {:.6g} s", *step, time) : fmt::format("t = {:.6g} s", time);
  if (place) line += fmt::format(", particle {}", place->particle);
  if (place && place->position) {
    const auto& [x, y, z] = *place->position;
    line += fmt::format(" at ({:.6g}, {:.6g}, {:.6g}) m", x, y, z);
  }
  return fmt::format("{}: {}", line, what);
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

DivergenceError::DivergenceError(std::string what, std::optional<int> step, double time, std::optional<Place> place)
    : std::runtime_error(divergence_text(what, step, time, place)),
      problem_(std::move(what)),
      step_(step),
      time_(time),
      place_(place) {}

DivergenceError::DivergenceError(std::string what, double time)
    : DivergenceError(std::move(what), std::nullopt, time, std::nullopt) {}

DivergenceError::DivergenceError(std::string what, double time, Place place)
    : DivergenceError(std::move(what), std::nullopt, time, std::optional<Place>(place)) {}

DivergenceError DivergenceError::at_step(int step) const {
  return DivergenceError(problem_, step_.value_or(step), time_, place_);
}

}  // namespace kiln
