#pragma once

#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// How long cases take, from those of the same kind that are done.
class CaseTimes {
 public:
  /// `kind`: its words from general to special, e.g. {"run", "gnat"}.
  void add(const std::vector<std::string>& kind, double seconds);
  /// Mean over the cases that share the most words with `kind`; nothing before any case is done.
  std::optional<double> expected(const std::vector<std::string>& kind) const;

 private:
  struct Sum {
    double seconds = 0.0;
    int count = 0;
  };
  std::map<std::vector<std::string>, Sum> sums_;  ///< by the first words of a kind, none for all
};

/// Shows on a stream how far a study is, a line a case:
///
///     [ 7/44] experiment-2/gnat-1e-3   0.16 s  done, 12:30 left
///
/// A terminal shows the case that runs as well (ProgressObserver.hpp: draws_bars()).
class StudyProgress {
 public:
  /// `stream` null: silent.
  StudyProgress(std::vector<std::string> names, std::FILE* stream, bool terminal);

  void begin(std::size_t index, std::optional<double> left);
  /// seconds: none for a case that did not run. left: expected for all cases after this one.
  void end(std::size_t index, std::optional<double> seconds, const std::string& outcome, std::optional<double> left);

 private:
  std::string label(std::size_t index) const;
  std::vector<std::string> names_;
  std::FILE* stream_;
  bool terminal_;
  std::size_t width_ = 0;
};

/// "0.16 s", "19.5 s", "2:05".
std::string short_duration(double seconds);

}  // namespace kiln
