#pragma once

#include <vector>

#include "framework/method/SolveTotals.hpp"
#include "framework/time/StepListener.hpp"
#include "framework/time/TimeScheme.hpp"

namespace kiln {

/// Steps first_step + 1 … last_step of uniform length; step n ends at n · step seconds.
struct TimeSpan {
  double step;
  int first_step;
  int last_step;
  int checkpoint_every = 0;       ///< steps between two checkpoints; 0: none at all
  double checkpoint_pause = 0.0;  ///< least wall time between two of them, in s

  /// From the input's blocks `time` (`step` and `end`) and `output.checkpoint`. Throws InputError if `end` is no
  /// multiple of `step` to 1e-6.
  static TimeSpan of(const Teuchos::ParameterList& input);
};

/// Sums of a run's solve reports, and where its time went.
struct LoopTotals : SolveTotals {
  double stepping_s = 0.0;   ///< wall time of this rank
  double observing_s = 0.0;  ///< likewise
};

/// Runs a method through its time span. `scheme` is started or restored already and x is the unknown at first_step;
/// listeners see the first moment only when first_step is 0. Adds the step to a DivergenceError. While a SignalWatch
/// lives, throws Stopped (StopRequest.hpp) after the step in which SIGTERM or SIGINT came, or after the first if one
/// came before, with a checkpoint of that step if `span` has any. Adds to `totals`, also of a run that is cut short.
void run_time_loop(Method& method, TimeScheme& scheme, VectorView x, const TimeSpan& span,
                   const std::vector<StepListener*>& listeners, LoopTotals& totals);
/// The same, returning the totals.
LoopTotals run_time_loop(Method& method, TimeScheme& scheme, VectorView x, const TimeSpan& span,
                         const std::vector<StepListener*>& listeners);

}  // namespace kiln
