#pragma once

#include <string>
#include <vector>

#include "framework/base/Error.hpp"
#include "framework/input/Location.hpp"

namespace kiln {

/// The mistakes found in an input so far, each with its place.
class Mistakes {
 public:
  /// `file` is read next: its mistakes are told after those of the files before it. Places that belong to no such
  /// file (overrides) come last.
  void begin_file(const std::string& file) { files_.push_back(file); }
  void add(const Location& location, Problem problem);
  std::size_t count() const { return mistakes_.size(); }
  /// Whether there are more already than will be told: no need to look for suggestions.
  bool enough() const { return mistakes_.size() >= most_told; }
  /// All mistakes by their position, "file:line:column: " before each; of very many the first ones, and their number.
  InputError error() const;

 private:
  static constexpr std::size_t most_told = 50;

  struct Mistake {
    Location location;
    Problem problem;
  };
  std::vector<std::string> files_;
  std::vector<Mistake> mistakes_;
};

}  // namespace kiln
