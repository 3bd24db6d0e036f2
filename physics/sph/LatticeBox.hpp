#pragma once

#include <array>
#include <optional>
#include <vector>

#include "physics/sph/HeatDomain.hpp"
#include "physics/sph/Lanes.hpp"

#ifdef KILN_LANES
namespace kiln {

/// A rank's rows and what surrounds them as a box of lattice places, cut into eight equal bricks, one for each lane:
/// place a of lane l along an axis is bricks[a]'s l · length + a. A vector then holds the same place of all bricks, and
/// neighbours at one offset are one vector at one distance in memory, aligned whatever the offset; each brick repeats
/// its surroundings.
struct LatticeBox {
  static constexpr LocalIndex none = -1;

  LatticePlace lower{};   ///< of the rows
  LatticePlace lanes{};   ///< bricks along each axis; their product is lane_count
  LatticePlace length{};  ///< places of a brick along each axis
  LatticePlace reach{};   ///< of the stencil
  /// Source at each place of each vector, lane by lane; none: no particle, or none that a row of this rank needs.
  std::vector<LocalIndex> sources;
  /// Vectors that hold rows, in an order in which neighbours stay in the cache.
  std::vector<LocalIndex> blocks;

  LocalIndex vectors_along(int axis) const { return length[axis] + 2 * reach[axis]; }
  LocalIndex vector(const LatticePlace& in_brick) const {
    return in_brick[0] + reach[0] +
           vectors_along(0) * (in_brick[1] + reach[1] + vectors_along(1) * (in_brick[2] + reach[2]));
  }
  LocalIndex distance(const LatticePlace& offset) const {
    return offset[0] + vectors_along(0) * (offset[1] + vectors_along(1) * offset[2]);
  }
};

/// Empty when the domain has no stencil or no rows, or when one of its pairs differs from the stencil's: the box is
/// checked against every pair.
std::optional<LatticeBox> lattice_box(const HeatDomain& domain);

}  // namespace kiln
#endif
