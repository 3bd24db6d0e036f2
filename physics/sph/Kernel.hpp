#pragma once

#include <Teuchos_ParameterList.hpp>

namespace kiln {

/// A radial smoothing kernel W(r, h) in three dimensions, normalised to ∫ W dV = 1, zero from r = 2h on.
class Kernel {
 public:
  struct Context {
    double smoothing_length;  ///< h in m, above 0
  };
  static constexpr const char* category = "kernel";

  virtual ~Kernel() = default;
  /// W(r) in 1/m³; r in m.
  virtual double value(double r) const = 0;
  /// (dW/dr)/r in 1/m⁵, so that r_ij·∇W_ij / r_ij² of Eq. 7 is this number; never above 0. r in m, above 0.
  virtual double gradient_over_distance(double r) const = 0;
};

}  // namespace kiln
