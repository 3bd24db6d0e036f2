#pragma once

#include <memory>
#include <vector>

#include "framework/time/MultistepCoefficients.hpp"
#include "framework/time/RungeKutta.hpp"
#include "framework/time/TimeScheme.hpp"

namespace kiln {

/// Linear multistep schemes (Eq. 14) with constant step. The history lives in row space, so that a reduced method's
/// residual sees the full states of its rows.
///
/// Until k states are known, a one-step scheme starts. It needs one order less than the scheme, because it makes only
/// k − 1 steps: backward Euler (explicit schemes: explicit Euler) up to order 2, the trapezoidal rule for implicit
/// schemes of order 3, rk4 beyond.
class LinearMultistep : public TimeScheme {
 public:
  /// Throws InputError, with paths below `path`, for coefficients that are no convergent scheme.
  LinearMultistep(MultistepCoefficients coefficients, const Context& context, const std::string& path = {});

  void start(ConstVectorView x, double time) override;
  SolveReport advance(VectorView x, double time) override;
  void save(hdf5::Group& group) const override;
  void restore(const hdf5::Group& group) override;

  const MultistepCoefficients& coefficients() const { return coefficients_; }
  /// The scheme of the first steps, unless starts_by_runge_kutta().
  const MultistepCoefficients& starter() const { return starter_; }
  bool starts_by_runge_kutta() const { return runge_kutta_starter_ != nullptr; }

 private:
  /// What is kept of one time level.
  struct Level {
    VectorView x;  ///< the method's unknown
    VectorView u;  ///< state at the rows
    VectorView f;  ///< rate at the rows; one array for all levels where earlier rates are not needed
    double time = 0.0;
  };

  void keep(Level& level, ConstVectorView x, double time);
  /// Arrays for as many rows as the method has now.
  void allocate_rows();
  /// States and rates of all levels, at rows that have changed.
  void evaluate_anew();
  void gather_history(const MultistepCoefficients& scheme);

  MultistepCoefficients coefficients_;
  MultistepCoefficients starter_;
  std::unique_ptr<RungeKuttaStep> runge_kutta_starter_;  ///< null where starter_ does
  Method& method_;
  double step_;
  std::vector<std::unique_ptr<Level>> levels_;  ///< newest first; k, and one more that the next step writes
  std::size_t known_ = 0;                       ///< levels that hold a state
  VectorView history_;                          ///< h of StepResidual
};

}  // namespace kiln
