#pragma once

#include <algorithm>
#include <vector>

#include "framework/model/Parameters.hpp"

namespace kiln {

/// Remembers the values that a model's parameters had when something was computed from them, as LastState does a state.
class LastParameters {
 public:
  bool are(const Parameters& parameters) const {
    const auto same = [](double last, const Parameter& parameter) { return last == *parameter.value; };
    return known_ &&
           std::equal(values_.begin(), values_.end(), parameters.list().begin(), parameters.list().end(), same);
  }
  /// Once what they were for has been computed.
  void remember(const Parameters& parameters) {
    values_.clear();
    for (const Parameter& parameter : parameters.list()) values_.push_back(*parameter.value);
    known_ = true;
  }

 private:
  std::vector<double> values_;
  bool known_ = false;
};

}  // namespace kiln
