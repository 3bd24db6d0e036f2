#pragma once

#include "framework/base/LinearAlgebra.hpp"
#include "framework/method/StepResidual.hpp"

namespace kiln {

/// Where a run stands when listeners are called.
struct Moment {
  int step;           ///< 0: initial state
  int last_step;      ///< number of the run's last step
  double time;        ///< in s
  ConstVectorView x;  ///< the method's unknown; the next step changes it
  SolveReport solve;  ///< of this step; empty at step 0
  /// A checkpoint of this step is written after the other listeners have seen it: a run that restarts from it needs all
  /// they have observed so far on the disk.
  bool checkpoint = false;
};

/// Looks at a run after its initial state and after every step. Calls are collective.
class StepListener {
 public:
  virtual ~StepListener() = default;
  virtual void observe(const Moment& moment) = 0;
};

}  // namespace kiln
