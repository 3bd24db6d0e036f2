#include "framework/input/Mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "framework/input/TextCheck.hpp"

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

namespace {

std::string escaped(const std::string& text, std::size_t longest) {
  std::string result;
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (++characters > longest) return result + "...";
    const std::size_t length = character_length(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte == '\n') {
      result += "\\n";
    } else if (byte == '\t') {
      result += "\\t";
    } else if (length == 0 || byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += text.substr(i, length);
    }
    i += std::max<std::size_t>(1, length);
  }
  return result;
}

}  // namespace

std::string printable(const std::string& text) { return escaped(text, text.size()); }
std::string shown(const std::string& text, std::size_t longest) { return escaped(text, longest); }

std::string in_quotes(const std::string& text) { return "'" + shown(text) + "'"; }

}  // namespace kiln
