#include "physics/sph/LatticeBox.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#ifdef KILN_LANES
namespace kiln {
namespace {

constexpr LocalIndex none = LatticeBox::none;

/// Which source stands at a place, around the rows.
class PlaceIndex {
 public:
  PlaceIndex(const LatticeStencil& stencil, const LatticePlace& lower, const LatticePlace& upper)
      : stencil_(stencil), lower_(lower) {
    for (int axis = 0; axis < 3; ++axis) size_[axis] = upper[axis] - lower[axis] + 1;
    sources_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2], none);
  }
  /// False if the place is taken or outside.
  bool put(LocalIndex source, const LatticePlace& place) {
    const auto at = index(place);
    if (!at || sources_[*at] != none) return false;
    sources_[*at] = source;
    return true;
  }
  LocalIndex at(const LatticePlace& place) const {
    const auto found = index(stencil_.original(place));
    return found ? sources_[*found] : none;
  }

 private:
  std::optional<std::size_t> index(const LatticePlace& place) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (place[axis] < lower_[axis] || place[axis] >= lower_[axis] + size_[axis]) return std::nullopt;
    }
    return (place[0] - lower_[0]) +
           static_cast<std::size_t>(size_[0]) *
               ((place[1] - lower_[1]) + static_cast<std::size_t>(size_[1]) * (place[2] - lower_[2]));
  }

  const LatticeStencil& stencil_;
  LatticePlace lower_;
  LatticePlace size_{};
  std::vector<LocalIndex> sources_;
};

LatticePlace sum(const LatticePlace& a, const LatticePlace& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

/// Whether the stencil gives each row the neighbours and weights that the domain lists.
bool fits(const HeatDomain& domain, const LatticeStencil& stencil, const PlaceIndex& index,
          const std::vector<LatticePlace>& places) {
  const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.offsets);
  const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.neighbours);
  const auto weights = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.weights);
  double largest = 0.0;
  for (const double weight : stencil.weights) largest = std::max(largest, std::abs(weight));
  std::vector<double> found(places.size(), 0.0);
  for (LocalIndex row = 0; row < static_cast<LocalIndex>(domain.areas.extent(0)); ++row) {
    double all = 0.0;
    for (std::size_t n = 0; n < stencil.offsets.size(); ++n) {
      const LocalIndex source = index.at(sum(places[row], stencil.offsets[n]));
      if (source == none || source == row) continue;
      found[source] += stencil.weights[n];
      all += stencil.weights[n];
    }
    for (std::size_t pair = offsets(row); pair < offsets(row + 1); ++pair) {
      const LocalIndex source = neighbours(pair);
      if (std::abs(found[source] - weights(pair)) > 1e-10 * largest) return false;
      all -= found[source];
      found[source] = 0.0;
    }
    // What is left belongs to a source that is no neighbour.
    if (std::abs(all) > 1e-10 * largest) return false;
  }
  return true;
}

/// Eight bricks that make the fewest vectors; of equal ones, those with the fewest surroundings.
void choose_bricks(LatticeBox& box, const LatticePlace& size) {
  double fewest = std::numeric_limits<double>::infinity();
  for (const LocalIndex x : {1, 2, 4, 8}) {
    for (const LocalIndex y : {1, 2, 4, 8}) {
      if (x * y > lane_count) continue;
      const LatticePlace lanes = {x, y, lane_count / (x * y)};
      double inside = 1.0;
      double all = 1.0;
      LatticePlace length{};
      for (int axis = 0; axis < 3; ++axis) {
        length[axis] = (size[axis] + lanes[axis] - 1) / lanes[axis];
        inside *= length[axis];
        all *= length[axis] + 2 * box.reach[axis];
      }
      // Filling a vector costs a fiftieth of a block of a stencil of 120.
      if (inside + 0.02 * all >= fewest) continue;
      fewest = inside + 0.02 * all;
      box.lanes = lanes;
      box.length = length;
    }
  }
}

/// Calls visit(place in a brick) for a box of places, y in tiles so narrow that what a row of tiles reads stays in a
/// cache of 2 MiB.
template <class Visit>
void visit_tiled(const LatticeBox& box, const Visit& visit) {
  const double layer = 3.0 * lane_count * sizeof(double) * box.vectors_along(0) * (2 * box.reach[2] + 1);
  const auto lines = static_cast<LocalIndex>(1.2e6 / layer) - 2 * box.reach[1];
  const LocalIndex tile = std::max<LocalIndex>(lines, 4);
  for (LocalIndex first = 0; first < box.length[1]; first += tile) {
    for (LocalIndex z = 0; z < box.length[2]; ++z) {
      for (LocalIndex y = first; y < std::min(first + tile, box.length[1]); ++y) {
        for (LocalIndex x = 0; x < box.length[0]; ++x) visit({x, y, z});
      }
    }
  }
}

}  // namespace

std::optional<LatticeBox> lattice_box(const HeatDomain& domain) {
  const auto rows = static_cast<LocalIndex>(domain.areas.extent(0));
  if (!domain.stencil || rows == 0) return std::nullopt;
  const LatticeStencil& stencil = *domain.stencil;
  const auto positions = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.positions);
  std::vector<LatticePlace> places;
  for (std::size_t s = 0; s < positions.extent(0); ++s) {
    places.push_back(stencil.place({positions(s, 0), positions(s, 1), positions(s, 2)}));
  }
  LatticeBox box;
  for (const LatticePlace& offset : stencil.offsets) {
    for (int axis = 0; axis < 3; ++axis) box.reach[axis] = std::max(box.reach[axis], offset[axis]);
  }
  box.lower = places.front();
  LatticePlace upper = places.front();
  for (LocalIndex row = 0; row < rows; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = std::min(box.lower[axis], places[row][axis]);
      upper[axis] = std::max(upper[axis], places[row][axis]);
    }
  }
  const LatticePlace size = {upper[0] - box.lower[0] + 1, upper[1] - box.lower[1] + 1, upper[2] - box.lower[2] + 1};
  choose_bricks(box, size);
  // A pair of the stencil takes a third of the time of a listed one.
  const double work = static_cast<double>(lane_count) * box.length[0] * box.length[1] * box.length[2] *
                      static_cast<double>(stencil.offsets.size());
  if (work > 2.0 * static_cast<double>(domain.pairs.neighbours.extent(0)) + 1e5) return std::nullopt;

  LatticePlace outer_lower = box.lower;
  LatticePlace outer_upper = upper;
  for (const LatticePlace& place : places) {
    for (int axis = 0; axis < 3; ++axis) {
      outer_lower[axis] = std::min(outer_lower[axis], place[axis]);
      outer_upper[axis] = std::max(outer_upper[axis], place[axis]);
    }
  }
  PlaceIndex index(stencil, outer_lower, outer_upper);
  for (std::size_t s = 0; s < places.size(); ++s) {
    if (!index.put(static_cast<LocalIndex>(s), places[s])) return std::nullopt;
  }
  if (!fits(domain, stencil, index, places)) return std::nullopt;

  const auto vectors = static_cast<std::size_t>(box.vectors_along(0)) * box.vectors_along(1) * box.vectors_along(2);
  if (vectors * 3 * lane_count > static_cast<std::size_t>(std::numeric_limits<LocalIndex>::max())) return std::nullopt;
  box.sources.assign(vectors * lane_count, none);
  for (LocalIndex z = -box.reach[2]; z < box.length[2] + box.reach[2]; ++z) {
    for (LocalIndex y = -box.reach[1]; y < box.length[1] + box.reach[1]; ++y) {
      for (LocalIndex x = -box.reach[0]; x < box.length[0] + box.reach[0]; ++x) {
        for (LocalIndex lane = 0; lane < lane_count; ++lane) {
          const LatticePlace brick = {lane % box.lanes[0], lane / box.lanes[0] % box.lanes[1],
                                      lane / (box.lanes[0] * box.lanes[1])};
          const LatticePlace place = {box.lower[0] + brick[0] * box.length[0] + x,
                                      box.lower[1] + brick[1] * box.length[1] + y,
                                      box.lower[2] + brick[2] * box.length[2] + z};
          box.sources[static_cast<std::size_t>(box.vector({x, y, z})) * lane_count + lane] = index.at(place);
        }
      }
    }
  }
  visit_tiled(box, [&](const LatticePlace& in_brick) {
    const LocalIndex vector = box.vector(in_brick);
    const LocalIndex* lanes = &box.sources[static_cast<std::size_t>(vector) * lane_count];
    if (std::any_of(lanes, lanes + lane_count, [rows](LocalIndex s) { return s != none && s < rows; })) {
      box.blocks.push_back(vector);
    }
  });
  return box;
}

}  // namespace kiln
#endif
