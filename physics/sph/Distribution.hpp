#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/Particles.hpp"

namespace kiln {

/// Number of other particles within `radius` (m) of each particle: the work a particle costs. Ranks share the counting
/// and all get all counts. Collective.
std::vector<double> neighbour_counts(const std::vector<Point>& positions, double radius,
                                     const Communicator& communicator);

/// Ids, ascending, of the particles that part number `part` of `parts` holds after recursive coordinate bisection
/// (Berger and Bokhari, IEEE Trans. Computers 36 (1987) 570): the box of a group of parts is cut across its longest
/// edge where the weights on both sides match the numbers of parts. Every particle is in exactly one part; no
/// communication, the same on every rank. Parts may be empty when there are more of them than particles.
std::vector<GlobalIndex> coordinate_bisection(const std::vector<Point>& positions, const std::vector<double>& weights,
                                              int parts, int part);

}  // namespace kiln
