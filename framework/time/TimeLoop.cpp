#include "framework/time/TimeLoop.hpp"

#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Map.hpp>
#include <chrono>
#include <cmath>
#include <limits>

#include "framework/base/Error.hpp"
#include "framework/base/StopRequest.hpp"

namespace kiln {
namespace {

void show(const Moment& moment, const std::vector<StepListener*>& listeners) {
  for (StepListener* listener : listeners) listener->observe(moment);
}

/// Adds up what lies between its calls. A reduced step takes no longer than some calls of Teuchos::TimeMonitor.
class Lap {
 public:
  void add_to(double& seconds) {
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - since_).count();
    since_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point since_ = Clock::now();
};

/// Tells after which steps a checkpoint is written; the same on every rank.
class Checkpoints {
 public:
  Checkpoints(const TimeSpan& span, const Communicator& communicator)
      : span_(span), communicator_(communicator), last_(Clock::now()) {}

  bool due(int step) {
    if (span_.checkpoint_every == 0) return false;
    if (step % span_.checkpoint_every != 0 && step != span_.last_step) return false;
    if (span_.checkpoint_pause == 0.0) return true;
    const std::chrono::duration<double> since = Clock::now() - last_;
    int due = since.count() >= span_.checkpoint_pause ? 1 : 0;
    Teuchos::broadcast(communicator_, 0, &due);
    if (due == 1) last_ = Clock::now();
    return due == 1;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const TimeSpan& span_;
  const Communicator& communicator_;
  Clock::time_point last_;
};

}  // namespace

TimeSpan TimeSpan::of(const Teuchos::ParameterList& input) {
  const Teuchos::ParameterList& time = input.sublist("time");
  const double step = time.get<double>("step");
  const double end = time.get<double>("end");
  const double count = std::round(end / step);
  if (!(count >= 1.0) || std::abs(end / step - count) > 1e-6) {
    throw InputError("time.end", fmt::format("{:.10g} s is {:.10g} steps of {:.10g} s", end, end / step, step),
                     "a whole number of steps, at least one");
  }
  if (count > std::numeric_limits<int>::max()) {
    throw InputError("time.end", fmt::format("{:.10g} s is {:.4g} steps of {:.10g} s", end, count, step),
                     fmt::format("at most {} steps", std::numeric_limits<int>::max()));
  }
  TimeSpan span{step, 0, static_cast<int>(count)};
  if (input.isSublist("output") && input.sublist("output").isSublist("checkpoint")) {
    span.checkpoint_every = input.sublist("output").sublist("checkpoint").get<int>("every");
    span.checkpoint_pause = input.sublist("output").sublist("checkpoint").get<double>("pause");
  }
  return span;
}

void run_time_loop(Method& method, TimeScheme& scheme, VectorView unknown, const TimeSpan& span,
                   const std::vector<StepListener*>& listeners, LoopTotals& totals) {
  const VectorView x = uncounted(unknown);
  const Communicator& communicator = *method.particles()->getComm();
  Checkpoints checkpoints(span, communicator);
  StopRequest stop(communicator, span.first_step);
  Lap lap;
  if (span.first_step == 0) show({0, span.last_step, 0.0, x, {}}, listeners);
  lap.add_to(totals.observing_s);
  for (int step = span.first_step + 1; step <= span.last_step; ++step) {
    const double time = step * span.step;
    SolveReport solve;
    try {
      solve = scheme.advance(x, time);
    } catch (const DivergenceError& error) {
      lap.add_to(totals.stepping_s);
      throw error.at_step(step);
    }
    lap.add_to(totals.stepping_s);
    totals.add(solve);
    const bool stopped = stop.came(step) && step < span.last_step;
    const bool checkpoint = checkpoints.due(step) || (stopped && span.checkpoint_every > 0);
    show({step, span.last_step, time, x, solve, checkpoint}, listeners);
    lap.add_to(totals.observing_s);
    if (stopped) {
      throw Stopped(fmt::format("{} came: stopped after step {} of {}, t = {:.6g} s", StopRequest::name(), step,
                                span.last_step, time));
    }
  }
}

LoopTotals run_time_loop(Method& method, TimeScheme& scheme, VectorView x, const TimeSpan& span,
                         const std::vector<StepListener*>& listeners) {
  LoopTotals totals;
  run_time_loop(method, scheme, x, span, listeners, totals);
  return totals;
}

}  // namespace kiln
