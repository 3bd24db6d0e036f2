#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Vortex particles in the order of their global ids; the same on every rank.
struct VortexCloud {
  std::vector<double> x;            ///< m
  std::vector<double> y;            ///< m
  std::vector<double> circulation;  ///< Γ in m²/s, counter-clockwise above 0

  void add(double at_x, double at_y, double of_circulation) {
    x.push_back(at_x);
    y.push_back(at_y);
    circulation.push_back(of_circulation);
  }
};

/// Where the vortices are at t = 0, and how strong.
class Vortices {
 public:
  struct Context {
    Teuchos::RCP<const Communicator> communicator;
  };
  static constexpr const char* category = "vortices";

  virtual ~Vortices() = default;
  /// Collective.
  virtual VortexCloud cloud() const = 0;
};

}  // namespace kiln
