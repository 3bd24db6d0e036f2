#pragma once

#include <algorithm>
#include <vector>

#include "framework/time/StepListener.hpp"

namespace kiln {

/// Keeps the unknown x of given steps, ascending, which must outlive the record.
class UnknownRecord : public StepListener {
 public:
  explicit UnknownRecord(const std::vector<int>& steps) : steps_(steps) {}
  void observe(const Moment& moment) override {
    if (!std::binary_search(steps_.begin(), steps_.end(), moment.step)) return;
    unknowns_.emplace_back("kiln::rom::unknown", moment.x.extent(0));
    times_.push_back(moment.time);
    Kokkos::deep_copy(unknowns_.back(), moment.x);
  }
  const std::vector<VectorView>& unknowns() const { return unknowns_; }
  const std::vector<double>& times() const { return times_; }

 private:
  const std::vector<int>& steps_;
  std::vector<VectorView> unknowns_;
  std::vector<double> times_;
};

}  // namespace kiln
