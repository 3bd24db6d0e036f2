#pragma once

#include <csignal>
#include <stdexcept>
#include <string>

#include "framework/base/ExchangeInterval.hpp"
#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A run or a training that SIGTERM or SIGINT ended between two steps. Exit status 4.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// While it lives, SIGTERM (what batch systems send before they kill) and SIGINT (Ctrl-C) no longer end the program:
/// they are noted, for the loops to end in order; a second signal of the kind ends the program at once. A signal that
/// was ignored before, as of jobs in the background, stays so. One at a time, from before the first file is made until
/// the last is closed.
class SignalWatch {
 public:
  SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;
  ~SignalWatch();

 private:
  struct sigaction terminate_before_, interrupt_before_;
};

/// Tells a loop over steps that a signal came (SignalWatch), before the loop or during it. Ranks may hear of a signal
/// in different steps: they agree on one, as often as costs next to nothing and no signal waits longer than about a
/// quarter of a second or a step.
class StopRequest {
 public:
  /// `first_step`: the step before the loop's first.
  StopRequest(const Communicator& communicator, int first_step) : communicator_(communicator), interval_(first_step) {}

  /// Whether the loop is to end after this step; the same on every rank. Called after each step. Collective.
  bool came(int step);
  /// Throws Stopped, naming what was interrupted, if a signal has come to any rank: for work between loops. Collective.
  static void end_if_asked(const Communicator& communicator, const std::string& what);
  /// "SIGTERM" or "SIGINT"; of a rank that a signal did not reach itself, "a signal".
  static std::string name();

 private:
  const Communicator& communicator_;
  ExchangeInterval interval_;
};

}  // namespace kiln
