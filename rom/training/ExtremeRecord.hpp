#pragma once

#include <vector>

#include "framework/method/Method.hpp"
#include "framework/time/StepListener.hpp"

namespace kiln {

/// Writes down after every step which particles have the highest and the lowest value of each component, so that a
/// reduction can go on telling extremes.
class ExtremeRecord : public StepListener {
 public:
  explicit ExtremeRecord(Method& method);
  void observe(const Moment& moment) override;
  /// Their ids, as found. Collective.
  std::vector<GlobalIndex> ids() const;

 private:
  Method& method_;
  std::size_t components_;
  VectorView state_;
  /// Of this rank: for each step and component the highest value and minus the lowest, and where they are.
  std::vector<double> values_;
  std::vector<GlobalIndex> places_;
};

}  // namespace kiln
