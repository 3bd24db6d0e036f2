#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// The errors Kiln throws on purpose. Each carries what the message must name: the place, what was found and what
/// was expected. The command line turns them into an exit status; every rank throws the same one, and rank 0 prints.
namespace kiln {

/// One mistake in an input file. `path` is the dotted path of the entry ("model.heat_source.power"); the input layer
/// adds file, line and column when it prints.
struct Problem {
  std::string path;
  std::string found;       ///< what is wrong, e.g. "-4e-06 is not above 0"
  std::string expected;    ///< what was expected instead, e.g. "a time step in s above 0"; may be empty
  std::string suggestion;  ///< nearest valid word, printed as "did you mean …"; may be empty
};

/// One or more mistakes of the user's input, found while it is checked or while components are built from it.
/// Exit status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  InputError(std::string path, std::string found, std::string expected = {}, std::string suggestion = {});
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// A data file that is missing, unreadable, damaged or not what it should be; also an output place that cannot be
/// written. `place` is a dataset, an attribute, a line or empty. Exit status 2.
class FileError : public std::runtime_error {
 public:
  FileError(std::string file, std::string place, std::string found, std::string expected = {});
};

/// A method of an interface that a class does not offer, by both names. Exit status 2.
class NotOffered : public std::logic_error {
 public:
  /// `instead` says what a user can choose; may be empty.
  NotOffered(std::string_view class_name, std::string_view method, std::string_view instead = {});
};

/// A solve that diverged or a state that is not finite. Exit status 3. Solvers know the time only; whoever counts the
/// steps adds theirs with at_step. Every rank throws the same one.
class DivergenceError : public std::runtime_error {
 public:
  /// A particle with the worst value, and where it lies in metres if that is known.
  struct Place {
    long long particle;
    std::optional<std::array<double, 3>> position;
  };

  DivergenceError(std::string what, double time);
  DivergenceError(std::string what, double time, Place place);

  /// The same error with the step's number in front; a number already there stays.
  DivergenceError at_step(int step) const;
  const std::optional<int>& step() const { return step_; }
  const std::optional<Place>& place() const { return place_; }

 private:
  DivergenceError(std::string what, std::optional<int> step, double time, std::optional<Place> place);
  std::string problem_;
  std::optional<int> step_;
  double time_;
  std::optional<Place> place_;
};

}  // namespace kiln
