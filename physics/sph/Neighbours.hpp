#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/Particles.hpp"

namespace kiln {

using IndexView = Kokkos::View<LocalIndex*, Kokkos::LayoutLeft, Device>;
using ConstIndexView = Kokkos::View<const LocalIndex*, Kokkos::LayoutLeft, Device>;
using OffsetView = Kokkos::View<std::size_t*, Kokkos::LayoutLeft, Device>;
using ConstOffsetView = Kokkos::View<const std::size_t*, Kokkos::LayoutLeft, Device>;

/// Neighbours of chosen particles in compressed rows: those of target t are neighbours(offsets(t)) …
/// neighbours(offsets(t + 1) − 1), ascending, without the target itself.
struct NeighbourList {
  OffsetView offsets;
  IndexView neighbours;
};

/// Particles closer than radius (1 − 1e-10) to each target: pairs exactly at the radius, of which lattices have many,
/// count as outside whatever the rounding. By a grid of cells: count, scan, fill, sort. `targets` are indices into
/// `positions` (m).
NeighbourList find_neighbours(ConstPositionView positions, ConstIndexView targets, double radius);

/// Number of neighbours of each target, by the same rule.
OffsetView count_neighbours(ConstPositionView positions, ConstIndexView targets, double radius);

/// A target (index into `targets`) and one of its neighbours at the same place: closer than 1e-9 radius. Empty: none.
std::optional<std::pair<LocalIndex, LocalIndex>> coincident_pair(ConstPositionView positions, ConstIndexView targets,
                                                                 const NeighbourList& list, double radius);

PositionView position_view(const std::vector<Point>& positions);

}  // namespace kiln
