#include "physics/sph/HeatDomain.hpp"

#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "framework/base/Error.hpp"
#include "framework/base/Memory.hpp"
#include "framework/base/ViewOf.hpp"
#include "framework/model/ParticleMap.hpp"
#include "physics/sph/Distribution.hpp"
#include "physics/sph/PairWeights.hpp"

namespace kiln {
namespace {

std::string text(const Point& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p[0], p[1], p[2]); }

/// Beyond these, squares and cubes leave double precision, or the grid of the search its integers.
constexpr double farthest = 1e6;
constexpr double shortest_support = 1e-12;
/// A smoothing length of four spacings gives 2,144 neighbours.
constexpr double most_neighbours = 3000.0;

/// Of some particles, counted one by one.
double mean_neighbours(const std::vector<Point>& positions, double support) {
  const std::size_t stride = std::max<std::size_t>(1, positions.size() / 64);
  double pairs = 0.0, asked = 0.0;
  for (std::size_t i = 0; i < positions.size(); i += stride) {
    asked += 1.0;
    for (const Point& other : positions) {
      double square = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const double difference = positions[i][axis] - other[axis];
        square += difference * difference;
      }
      if (square < support * support) pairs += 1.0;
    }
  }
  return pairs / asked - 1.0;
}

void check_support(const ParticleCloud& cloud, const PairSettings& settings) {
  if (!(settings.support >= shortest_support) || !(settings.support <= farthest)) {
    throw InputError(settings.path + ".smoothing_length",
                     fmt::format("neighbours lie within 2h = {} m", settings.support),
                     fmt::format("{} m to {} m", shortest_support, farthest));
  }
  const auto particles = static_cast<double>(cloud.positions.size());
  const double neighbours = mean_neighbours(cloud.positions, settings.support);
  constexpr double bytes_a_pair = sizeof(double) + sizeof(LocalIndex);
  if (neighbours > most_neighbours || particles * neighbours * bytes_a_pair > machine_memory()) {
    throw InputError(
        settings.path + ".smoothing_length",
        fmt::format("about {:.3g} particles lie within 2h = {:.6g} m of one", neighbours, settings.support),
        fmt::format("at most {:g}, and pairs that fit into memory; is the spacing right?", most_neighbours));
  }
}

void check_masses(const ParticleCloud& cloud, const PairSettings& settings) {
  for (std::size_t id = 0; id < cloud.volumes.size(); ++id) {
    const double mass = settings.density * cloud.volumes[id];
    if (std::isnormal(mass) && mass > 0.0 && std::isfinite(cloud.heated_areas[id])) continue;
    throw InputError(
        settings.path + ".particles",
        fmt::format("particle {} has the mass {} kg and the heated area {} m^2", id, mass, cloud.heated_areas[id]),
        "a part of a size that double precision can tell");
  }
}

void check_positions(const ParticleCloud& cloud, const std::string& path) {
  for (std::size_t id = 0; id < cloud.positions.size(); ++id) {
    const Point& p = cloud.positions[id];
    if (!(std::abs(p[0]) <= farthest) || !(std::abs(p[1]) <= farthest) || !(std::abs(p[2]) <= farthest)) {
      throw InputError(path, fmt::format("particle {} lies at {}", id, text(p)),
                       fmt::format("finite coordinates, within {} m of 0", farthest));
    }
  }
  if (cloud.positions.empty()) throw InputError(path, "there is no particle", "at least 2");
}

/// Smallest value over all ranks.
GlobalIndex lowest(GlobalIndex value, const Communicator& communicator) {
  GlobalIndex result = value;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, 1, &value, &result);
  return result;
}

/// The particles a rank can need, ascending by id: its own and those around them.
struct Candidates {
  std::vector<GlobalIndex> ids;
  std::vector<LocalIndex> own;  ///< indices into ids
};

Candidates candidates(const std::vector<Point>& positions, const std::vector<GlobalIndex>& own, double support) {
  Candidates result;
  if (own.empty()) return result;
  Box box{positions[own.front()], positions[own.front()]};
  for (const GlobalIndex id : own) {
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = std::min(box.lower[axis], positions[id][axis]);
      box.upper[axis] = std::max(box.upper[axis], positions[id][axis]);
    }
  }
  auto next_own = own.begin();
  for (std::size_t id = 0; id < positions.size(); ++id) {
    bool near = true;
    for (int axis = 0; axis < 3; ++axis) {
      near =
          near && positions[id][axis] >= box.lower[axis] - support && positions[id][axis] <= box.upper[axis] + support;
    }
    if (!near) continue;
    if (next_own != own.end() && *next_own == static_cast<GlobalIndex>(id)) {
      result.own.push_back(static_cast<LocalIndex>(result.ids.size()));
      ++next_own;
    }
    result.ids.push_back(static_cast<GlobalIndex>(id));
  }
  return result;
}

void check_pairs(const ParticleCloud& cloud, const Candidates& around, const ConstPositionView& positions,
                 const IndexView& targets, const NeighbourList& pairs, const PairSettings& settings,
                 const Communicator& communicator) {
  constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();
  const std::string path = settings.path + ".particles";
  const auto coincident = coincident_pair(positions, targets, pairs, settings.support);
  const GlobalIndex mine = coincident ? around.ids[around.own[coincident->first]] : none;
  const GlobalIndex first = lowest(mine, communicator);
  if (first != none) {
    const GlobalIndex second = lowest(mine == first ? around.ids[coincident->second] : none, communicator);
    throw InputError(path,
                     fmt::format("particles {} and {} coincide at {}", first, second, text(cloud.positions[first])),
                     "particles at different places");
  }
  const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), pairs.offsets);
  GlobalIndex isolated = none;
  for (std::size_t t = 0; t < around.own.size() && isolated == none; ++t) {
    if (offsets(t + 1) == offsets(t)) isolated = around.ids[around.own[t]];
  }
  isolated = lowest(isolated, communicator);
  if (isolated != none) {
    throw InputError(
        path, fmt::format("particle {} at {} has no neighbour", isolated, text(cloud.positions[isolated])),
        fmt::format("at least one particle closer than 2h = {:.6g} m; is the spacing right?", settings.support));
  }
}

}  // namespace

HeatDomain whole_domain(const ParticleCloud& cloud, const PairSettings& settings,
                        const Teuchos::RCP<const Communicator>& communicator) {
  check_positions(cloud, settings.path + ".particles");
  check_support(cloud, settings);
  check_masses(cloud, settings);
  if (settings.mirrored && !cloud.faces) {
    throw InputError(settings.path + ".boundary", "mirrored boundaries need cells that fill a box",
                     "particles: {type: lattice, placement: cells, …}, or boundary: as printed");
  }
  const int ranks = communicator->getSize();
  const std::vector<double> work = ranks == 1 ? std::vector<double>(cloud.positions.size(), 1.0)
                                              : neighbour_counts(cloud.positions, settings.support, *communicator);
  const std::vector<GlobalIndex> own = coordinate_bisection(cloud.positions, work, ranks, communicator->getRank());
  const Candidates around = candidates(cloud.positions, own, settings.support);
  std::vector<Point> places;
  places.reserve(around.ids.size());
  for (const GlobalIndex id : around.ids) places.push_back(cloud.positions[id]);
  const ConstPositionView candidate_positions = position_view(places);
  const IndexView targets = view_of<IndexView>(around.own, "indices");
  NeighbourList pairs = find_neighbours(candidate_positions, targets, settings.support);
  check_pairs(cloud, around, candidate_positions, targets, pairs, settings, *communicator);

  HeatDomain domain;
  domain.mutual = true;
  const std::optional<Box> mirrors = settings.mirrored ? cloud.faces : std::nullopt;
  domain.weights = pair_weights(pairs, candidate_positions, targets, settings.kernel, settings.support, mirrors);
  domain.stencil = lattice_stencil(cloud.positions, settings.kernel, settings.support, mirrors);

  // From candidates to sources: own particles first, then those of the others that a pair refers to.
  constexpr LocalIndex unused = -1;
  std::vector<LocalIndex> local(around.ids.size(), unused);
  std::vector<GlobalIndex> sources(own);
  for (std::size_t t = 0; t < around.own.size(); ++t) local[around.own[t]] = static_cast<LocalIndex>(t);
  const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), pairs.neighbours);
  std::vector<char> needed(around.ids.size(), 0);
  for (std::size_t pair = 0; pair < neighbours.extent(0); ++pair) needed[neighbours(pair)] = 1;
  for (std::size_t c = 0; c < around.ids.size(); ++c) {
    if (needed[c] == 0 || local[c] != unused) continue;
    local[c] = static_cast<LocalIndex>(sources.size());
    sources.push_back(around.ids[c]);
  }
  for (std::size_t pair = 0; pair < neighbours.extent(0); ++pair) neighbours(pair) = local[neighbours(pair)];
  Kokkos::deep_copy(pairs.neighbours, neighbours);
  domain.pairs = pairs;

  std::vector<Point> source_places;
  std::vector<double> masses;
  for (const GlobalIndex id : sources) {
    source_places.push_back(cloud.positions[id]);
    masses.push_back(settings.density * cloud.volumes[id]);
  }
  std::vector<double> areas;
  for (const GlobalIndex id : own) areas.push_back(cloud.heated_areas[id]);
  domain.rows = map_of(own, communicator);
  domain.sources = map_of(sources, communicator);
  domain.positions = position_view(source_places);
  domain.masses = view_of<VectorView>(masses, "masses");
  domain.areas = view_of<VectorView>(areas, "heated areas");
  return domain;
}

}  // namespace kiln
