#pragma once

#include <algorithm>
#include <chrono>

namespace kiln {

/// How many steps the ranks of a time loop may go on before they next exchange what can wait: as many as take about a
/// quarter of a second, so that exchanging costs next to nothing beside short steps and nobody waits long beside long
/// ones.
class ExchangeInterval {
 public:
  /// `step`: the one before the loop's first.
  explicit ExchangeInterval(int step = 0) : last_(step), next_(step + 1), exchanged_(Clock::now()) {}

  /// The same on every rank.
  bool due(int step) const { return step >= next_; }
  /// This rank's guess, from the pace since the last exchange. At least 1.
  int steps_to_come(int step) const {
    const std::chrono::duration<double> passed = Clock::now() - exchanged_;
    const double a_step = passed.count() / std::max(1, step - last_);
    return std::max(1, static_cast<int>(std::min(seconds / std::max(a_step, 1e-9), double{most_steps})));
  }
  /// The ranks have exchanged after `step`, and agreed on the steps to come.
  void exchanged(int step, int steps_to_come) {
    last_ = step;
    next_ = step + steps_to_come;
    exchanged_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double seconds = 0.25;
  static constexpr int most_steps = 10000;

  int last_, next_;
  Clock::time_point exchanged_;
};

}  // namespace kiln
