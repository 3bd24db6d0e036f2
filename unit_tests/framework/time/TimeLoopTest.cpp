#include "framework/time/TimeLoop.hpp"

#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "framework/base/Error.hpp"
#include "framework/base/StopRequest.hpp"
#include "unit_tests/framework/method/FullOrderCases.hpp"

namespace kiln {
namespace {

Teuchos::ParameterList time_block(double step, double end) {
  Teuchos::ParameterList input;
  input.sublist("time").set("step", step).set("end", end);
  return input;
}

TEST(TimeSpan, CountsItsSteps) {
  const TimeSpan span = TimeSpan::of(time_block(4e-6, 4e-3));
  EXPECT_EQ(span.first_step, 0);
  EXPECT_EQ(span.last_step, 1000);
  EXPECT_EQ(span.step, 4e-6);
}

TEST(TimeSpan, RefusesAnEndBetweenSteps) {
  try {
    TimeSpan::of(time_block(0.3, 1.0));
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].path, "time.end");
    EXPECT_NE(std::string(error.what()).find("1 s is 3.333333333 steps of 0.3 s"), std::string::npos) << error.what();
  }
  EXPECT_THROW(TimeSpan::of(time_block(1.0, 1e-9)), InputError);
  EXPECT_THROW(TimeSpan::of(time_block(1e-12, 1.0)), InputError);
}

class Recorder : public StepListener {
 public:
  void observe(const Moment& moment) override {
    steps.push_back(moment.step);
    times.push_back(moment.time);
    EXPECT_EQ(moment.last_step, 4);
    EXPECT_EQ(moment.solve.residuals == 0, moment.step == 0);
  }
  std::vector<int> steps;
  std::vector<double> times;
};

std::unique_ptr<FullOrder> chain(int iterations) {
  return std::make_unique<FullOrder>(std::make_shared<DiffusionChain>(DiffusionChain::Settings{}, world()),
                                     newton(JacobianForm::diagonal, 1e-9, iterations));
}

TEST(TimeLoop, ListenersSeeEveryMoment) {
  const auto method = chain(100);
  const auto time_scheme = scheme("backward euler", *method, 0.1);
  const VectorView x = initial(*method);
  time_scheme->start(x, 0.0);
  Recorder all;
  const LoopTotals totals = run_time_loop(*method, *time_scheme, x, {0.1, 0, 4}, {&all});
  EXPECT_EQ(all.steps, (std::vector<int>{0, 1, 2, 3, 4}));
  for (int n = 0; n <= 4; ++n) EXPECT_EQ(all.times[n], n * 0.1);
  EXPECT_EQ(totals.steps, 4);
  EXPECT_EQ(totals.residuals, totals.iterations + 4);
  EXPECT_EQ(totals.capped_steps, 0);
  Recorder rest;
  time_scheme->start(x, 0.2);
  EXPECT_EQ(run_time_loop(*method, *time_scheme, x, {0.1, 2, 4}, {&rest}).steps, 2);
  EXPECT_EQ(rest.steps, (std::vector<int>{3, 4})) << "a continued run has shown its first moment already";
}

TEST(TimeLoop, CheckpointsAreDueAsAsked) {
  class Marks : public StepListener {
   public:
    void observe(const Moment& moment) override {
      if (moment.checkpoint) steps.push_back(moment.step);
    }
    std::vector<int> steps;
  };
  const auto method = chain(100);
  const auto time_scheme = scheme("backward euler", *method, 0.1);
  const VectorView x = initial(*method);
  const auto due = [&](const TimeSpan& span) {
    Marks marks;
    time_scheme->start(x, 0.1 * span.first_step);
    run_time_loop(*method, *time_scheme, x, span, {&marks});
    return marks.steps;
  };
  EXPECT_EQ(due({0.1, 0, 7, 3}), (std::vector<int>{3, 6, 7}));
  EXPECT_EQ(due({0.1, 2, 7, 4}), (std::vector<int>{4, 7}));
  EXPECT_TRUE(due({0.1, 0, 7}).empty());
  // A pause no run of seven steps lasts, and one that every step does.
  EXPECT_TRUE(due({0.1, 0, 7, 3, 1e6}).empty());
  EXPECT_EQ(due({0.1, 0, 7, 3, 1e-12}), (std::vector<int>{3, 6, 7}));
}

/// A run that hears of SIGTERM on one of its ranks ends on all of them after the same step, with a checkpoint.
TEST(TimeLoop, ASignalEndsItBetweenSteps) {
  class Raises : public StepListener {
   public:
    explicit Raises(int step) : step_(step) {}
    void observe(const Moment& moment) override {
      last = moment.step;
      checkpoint = moment.checkpoint;
      const bool mine = world()->getRank() == world()->getSize() - 1;
      if (moment.step == step_ && mine) std::raise(SIGTERM);
      // Ranks agree four times a second, or each step if that takes longer.
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    int last = 0;
    bool checkpoint = false;

   private:
    int step_;
  };
  const auto method = chain(100);
  const auto time_scheme = scheme("backward euler", *method, 0.1);
  const VectorView x = initial(*method);
  for (const int every : {0, 1000}) {
    const SignalWatch watch;
    Raises observer(3);
    time_scheme->start(x, 0.0);
    try {
      run_time_loop(*method, *time_scheme, x, {0.1, 0, 500, every}, {&observer});
      FAIL() << "not stopped";
    } catch (const Stopped& stopped) {
      EXPECT_GE(observer.last, 4);
      EXPECT_LT(observer.last, 60) << "the ranks agree within about a quarter of a second";
      EXPECT_EQ(observer.checkpoint, every > 0);
      const std::string told = stopped.what();
      EXPECT_NE(told.find("came: stopped after step " + std::to_string(observer.last) + " of 500"), std::string::npos)
          << told;
    }
    int lowest = observer.last, highest = observer.last;
    Teuchos::reduceAll(*world(), Teuchos::REDUCE_MIN, 1, &observer.last, &lowest);
    Teuchos::reduceAll(*world(), Teuchos::REDUCE_MAX, 1, &observer.last, &highest);
    EXPECT_EQ(lowest, highest);
  }
  // A signal in the last step changes nothing for this loop; it ends the next.
  const SignalWatch watch;
  Raises last(4);
  time_scheme->start(x, 0.0);
  EXPECT_EQ(run_time_loop(*method, *time_scheme, x, {0.1, 0, 4}, {&last}).steps, 4);
  time_scheme->start(x, 0.0);
  EXPECT_THROW(run_time_loop(*method, *time_scheme, x, {0.1, 0, 500}, {}), Stopped);
}

TEST(TimeLoop, CappedStepsAreCounted) {
  const auto method = chain(2);
  const auto time_scheme = scheme("backward euler", *method, 0.1);
  const VectorView x = initial(*method);
  time_scheme->start(x, 0.0);
  const LoopTotals totals = run_time_loop(*method, *time_scheme, x, {0.1, 0, 4}, {});
  EXPECT_EQ(totals.capped_steps, 4);
  EXPECT_EQ(totals.iterations, 8);
}

TEST(TimeLoop, ADivergenceCarriesItsStep) {
  class Failing : public DiffusionChain {
   public:
    Failing() : DiffusionChain({}, world()) {}
    void rate(ConstVectorView u, double time, VectorView f) const override {
      DiffusionChain::rate(u, time, f);
      if (time > 0.25 && rows()->isNodeGlobalElement(14)) f(rows()->getLocalElement(14)) = std::nan("");
    }
  };
  FullOrder method(std::make_shared<Failing>(), newton(JacobianForm::diagonal));
  const auto time_scheme = scheme("backward euler", method, 0.1);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  try {
    run_time_loop(method, *time_scheme, x, {0.1, 0, 9}, {});
    FAIL() << "no DivergenceError";
  } catch (const DivergenceError& error) {
    EXPECT_EQ(
        std::string(error.what()).find("step 3, t = 0.3 s, particle 14 at (7, 0, 0) m: the residual is not finite"), 0u)
        << error.what();
    EXPECT_EQ(error.step(), 3);
    EXPECT_EQ(error.place()->particle, 14);
  }
}

}  // namespace
}  // namespace kiln
