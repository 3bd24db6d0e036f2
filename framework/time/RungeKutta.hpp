#pragma once

#include <vector>

#include "framework/time/ButcherTableau.hpp"
#include "framework/time/TimeScheme.hpp"

namespace kiln {

/// One step of an explicit Runge–Kutta method in a method's unknown, with the storage of its stages.
class RungeKuttaStep {
 public:
  RungeKuttaStep(ButcherTableau tableau, Method& method, double step);
  /// Advances x from `time` by one step. Returns the evaluations of f.
  int advance(VectorView x, double time);

 private:
  ButcherTableau tableau_;
  Method& method_;
  double step_;
  VectorView stage_;
  std::vector<VectorView> slopes_;
};

/// Explicit Runge–Kutta schemes. They integrate dx/dt through Method::rate and keep no history but the time they stand
/// at.
class RungeKutta : public TimeScheme {
 public:
  RungeKutta(ButcherTableau tableau, const Context& context);

  void start(ConstVectorView x, double time) override;
  SolveReport advance(VectorView x, double time) override;
  void save(hdf5::Group& group) const override;
  void restore(const hdf5::Group& group) override;

 private:
  Method& method_;
  RungeKuttaStep step_;
  double time_ = 0.0;
};

}  // namespace kiln
