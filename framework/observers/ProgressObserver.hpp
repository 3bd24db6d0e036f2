#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/observers/Observer.hpp"

namespace kiln {

/// Shows on rank 0's standard error how far a run is: a bar with the time left if that is a terminal (or the
/// environment says KILN_PROGRESS=bar, which reaches through mpirun's pipes), redrawn at most once a second, else a
/// line every 10 %. The driver creates it; it is no block of the input.
class ProgressObserver : public Observer {
 public:
  /// `label` stands in front of the bar, e.g. "full order". `first_step` counts as done already when time left is
  /// told.
  ProgressObserver(std::string label, int first_step, const Communicator& communicator);
  /// For another stream; `terminal` says whether to draw a bar.
  ProgressObserver(std::string label, int first_step, std::FILE* stream, bool terminal);

  void begin() override {}
  void observe(const Moment& moment) override;
  void finish(RunReport& report) override;

 private:
  using Clock = std::chrono::steady_clock;
  void draw_bar(const Moment& moment);
  void print_line(const Moment& moment);
  std::string time_left(const Moment& moment) const;

  std::string label_;
  int first_step_;
  std::FILE* stream_;  ///< null: silent
  bool terminal_;
  Clock::time_point start_;
  Clock::time_point drawn_;
  int tenths_ = 0;
  bool open_line_ = false;
};

/// Whether progress is shown as a bar that redraws itself, not as lines.
bool draws_bars();

/// "1:02:03", "2:05" or "12 s".
std::string duration_text(double seconds);

}  // namespace kiln
