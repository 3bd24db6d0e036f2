#pragma once

#include <array>
#include <optional>
#include <vector>

#include "physics/sph/Kernel.hpp"
#include "physics/sph/Particles.hpp"

namespace kiln {

using LatticePlace = std::array<LocalIndex, 3>;  ///< index along x, y, z; from 0

/// The neighbours that every particle of a rectangular lattice has, as far as the part reaches: found from the
/// particles, whatever they were read from. Places without a particle are allowed.
struct LatticeStencil {
  Point lower;            ///< place {0, 0, 0}, in m
  Point spacing;          ///< in m
  LatticePlace layers;    ///< places along each axis
  bool mirrored = false;  ///< the part continues in its mirror images, half a spacing beyond its last layers
  /// Each offset is followed by its opposite, which has the same weight.
  std::vector<LatticePlace> offsets;
  std::vector<double> weights;  ///< (dW/dr)/r in 1/m⁵ of each offset

  LatticePlace place(const Point& position) const;
  /// The place that a mirror image shows; the place itself without mirrors.
  LatticePlace original(LatticePlace place) const;
};

/// `positions`: of all particles of the part; `support` in m. Empty when particles stand elsewhere than on a
/// rectangular lattice (by more than 1e-9 of a spacing), or on less than half of one.
std::optional<LatticeStencil> lattice_stencil(const std::vector<Point>& positions, const Kernel& kernel, double support,
                                              const std::optional<Box>& mirrors);

}  // namespace kiln
