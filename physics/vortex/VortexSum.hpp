#pragma once

#include <utility>
#include <vector>

#include "physics/vortex/VortexKernel.hpp"

namespace kiln {

/// Rows at which velocities are wanted.
struct VortexTargets {
  const double* points;      ///< x and y of each in m
  const LocalIndex* places;  ///< of each among the vortices
  LocalIndex count;
};

/// How the sum of every vortex at every target is formed. On the other targets, and on how they are dealt out to ranks,
/// no more than the rounding of a target's velocity depends.
class VortexSum {
 public:
  using Context = NoContext;
  static constexpr const char* category = "vortex sum";

  virtual ~VortexSum() = default;
  /// factor Σ_j Γ_j q r⊥ of each target. velocities: u and v of each in m/s, overwritten. Evaluations write to work
  /// arrays that the object keeps: one at a time.
  virtual void velocities(const VortexKernel& kernel, const VortexArrays& vortices, const VortexTargets& targets,
                          double factor, double* velocities) = 0;
};

}  // namespace kiln
