#pragma once

#include <array>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The particle nearest to a point, over all ranks; of equally near ones that of the lowest id. Lengths in m.
struct NearestParticle {
  GlobalIndex id = -1;  ///< −1: there is none, or none that is known to be the nearest
  int rank = -1;        ///< where it lies
  LocalIndex local = -1;
  std::array<double, 3> position{};
  double distance = 0.0;
  double spacing = 0.0;  ///< from it to its own nearest neighbour; 0 if it is alone
};

/// positions: the particles of `map`, in m. Collective.
NearestParticle nearest_particle(const Map& map, ConstPositionView positions, const std::array<double, 3>& point);

/// Lower and upper corner of all particles' box, in m. Collective.
std::array<std::array<double, 3>, 2> bounding_box(ConstPositionView positions, const Communicator& communicator);

}  // namespace kiln
