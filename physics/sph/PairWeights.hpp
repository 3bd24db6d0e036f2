#pragma once

#include <optional>

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/Kernel.hpp"
#include "physics/sph/Neighbours.hpp"
#include "physics/sph/Particles.hpp"

namespace kiln {

/// (dW/dr)/r in 1/m⁵ of each pair of `list`, in its order; `targets` and neighbours are indices into `positions` (m).
/// With `faces` each weight also sums over the mirror images of the neighbour in the six faces of the box, repeated as
/// far as the support reaches (edges, corners and parts thinner than the support included): the part is surrounded by
/// insulated ghosts. |x_i − image(x_j)| = |image(x_i) − x_j|, so weights stay symmetric and energy is kept.
VectorView pair_weights(const NeighbourList& list, ConstPositionView positions, ConstIndexView targets,
                        const Kernel& kernel, double support, const std::optional<Box>& faces);

}  // namespace kiln
