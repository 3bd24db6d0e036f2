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
  /// Ids of the chosen particles in ascending order, the same on every rank whatever the number of ranks. `modes`: Φ_r
  /// on this rank's rows, particles of `rows` × components by residual rank; `rows` holds each particle on one rank.
  /// Throws InputError where the particles asked for are too few to determine Φ_r or more than there are. Collective.
  virtual std::vector<GlobalIndex> sample(const Map& rows, ConstMatrixView modes, int components) const = 0;
};

}  // namespace kiln
