#pragma once

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/Parameters.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {

/// Heat flux into the heated surface, q of Eq. 9.
class HeatSource {
 public:
  using Context = NoContext;
  static constexpr const char* category = "heat source";

  HeatSource() = default;
  // Live parameters point into the object.
  HeatSource(const HeatSource&) = delete;
  HeatSource& operator=(const HeatSource&) = delete;
  virtual ~HeatSource() = default;

  /// q in W/m² at each position (m) at a time (s); overwritten. Depends on these and on the parameters alone: for one
  /// time it is asked once.
  virtual void flux(double time, ConstPositionView positions, VectorView q) const = 0;

  Parameters& parameters() { return parameters_; }
  const Parameters& parameters() const { return parameters_; }

 protected:
  Parameters parameters_;
};

}  // namespace kiln
