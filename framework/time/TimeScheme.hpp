#pragma once

#include "framework/method/Method.hpp"
#include "framework/method/StepResidual.hpp"

namespace kiln {

/// Advances a method's unknown by one step after another. Registered schemes: explicit Runge–Kutta tableaux and linear
/// multistep coefficients (Eq. 14).
class TimeScheme {
 public:
  struct Context {
    Method& method;
    double step;  ///< Δt in s, uniform
  };
  static constexpr const char* category = "time scheme";

  virtual ~TimeScheme() = default;

  /// Takes x as the state at `time`; forgets all history.
  virtual void start(ConstVectorView x, double time) = 0;
  /// Advances x from t^{n−1} to `time` = t^n.
  virtual SolveReport advance(VectorView x, double time) = 0;

  /// History for a bitwise restart: earlier x and their times; states and rates are evaluated anew.
  virtual void save(hdf5::Group& group) const = 0;
  virtual void restore(const hdf5::Group& group) = 0;
};

}  // namespace kiln
