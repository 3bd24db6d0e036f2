#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {

/// Chooses the particles a hyper-reduced method evaluates (the rows of P in Θ = [PΦ_r]⁺P).
class Sampling {
 public:
  using Context = NoContext;
  static constexpr const char* category = "sampling";

  virtual ~Sampling() = default;
  /// Throws InputError for what sample() would refuse of a model of so many particles and components, told before a
  /// training. `residual_modes`: how many there will be, 0 where the snapshots decide.
  virtual void check(GlobalIndex particles, int components, int residual_modes) const = 0;
  /// Ids of the chosen particles in ascending order, the same on every rank whatever the number of ranks. `modes`: Φ_r
  /// on this rank's rows, particles of `rows` × components by residual rank; `rows` holds each particle on one rank.
  /// Throws InputError where the particles asked for are too few to determine Φ_r or more than there are. Collective.
  virtual std::vector<GlobalIndex> sample(const Map& rows, ConstMatrixView modes, int components) const = 0;
};

}  // namespace kiln
