#pragma once

#include <chrono>
#include <stdexcept>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A run or a training that SIGTERM or SIGINT ended between two steps. Exit status 4.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Notices SIGTERM (what batch systems send before they kill) and SIGINT (Ctrl-C) while it lives, so that a time loop
/// can end in order; a second signal ends the program at once. Ranks may hear of a signal in different steps: they
/// agree on one, as often as costs next to nothing and no signal waits longer than about a quarter of a second or a
/// step.
class StopRequest {
 public:
  /// `first_step`: the step before the loop's first.
  StopRequest(const Communicator& communicator, int first_step);
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  ~StopRequest();

  /// Whether the loop is to end after this step; the same on every rank. Called after each step. Collective.
  bool came(int step);
  /// "SIGTERM" or "SIGINT"; of a rank that a signal did not reach itself, "a signal".
  static std::string name();

 private:
  using Clock = std::chrono::steady_clock;

  const Communicator& communicator_;
  int next_ = 0;  ///< step after which the ranks agree again
  int asked_step_;
  Clock::time_point asked_;
};

}  // namespace kiln
