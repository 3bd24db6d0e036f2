#pragma once

namespace kiln::test {

/// Numbers between 0 and 1 without a pattern, the same everywhere.
class Random {
 public:
  explicit Random(unsigned seed) : state_(seed) {}
  double next() {
    state_ = state_ * 1664525u + 1013904223u;
    return state_ / 4294967296.0;
  }
  double between(double low, double high) { return low + (high - low) * next(); }

 private:
  unsigned state_;
};

}  // namespace kiln::test
