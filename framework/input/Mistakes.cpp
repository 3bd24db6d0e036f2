#include "framework/input/Mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace kiln {

std::string to_string(const Location& location) {
  return location.line == 0 ? location.file : fmt::format("{}:{}:{}", location.file, location.line, location.column);
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

std::string shown(const std::string& text) {
  constexpr std::size_t longest = 60;
  std::string result;
  std::size_t characters = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues_character = (byte & 0xc0) == 0x80;
    if (!continues_character && ++characters > longest) {
      result += "...";
      break;
    }
    if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += c;
    }
  }
  return result;
}

std::string in_quotes(const std::string& text) { return "'" + shown(text) + "'"; }

}  // namespace kiln
