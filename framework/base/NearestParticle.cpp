#include "framework/base/NearestParticle.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

namespace kiln {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using HostPositions = ConstPositionView::HostMirror;

HostPositions on_host(ConstPositionView positions) {
  const auto host = Kokkos::create_mirror_view(positions);
  Kokkos::deep_copy(host, positions);
  return host;
}

double squared_distance(const HostPositions& positions, std::size_t i, const std::array<double, 3>& point) {
  double sum = 0.0;
  for (std::size_t d = 0; d < 3; ++d) sum += (positions(i, d) - point[d]) * (positions(i, d) - point[d]);
  return sum;
}

double minimum(const Communicator& communicator, double mine) {
  double least = infinite;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, 1, &mine, &least);
  return least;
}

}  // namespace

NearestParticle nearest_particle(const Map& map, ConstPositionView positions, const std::array<double, 3>& point) {
  const Communicator& communicator = *map.getComm();
  const HostPositions host = on_host(positions);
  constexpr auto none = std::numeric_limits<GlobalIndex>::max();
  double least = infinite;
  GlobalIndex id = none;
  LocalIndex local = -1;
  for (std::size_t i = 0; i < host.extent(0); ++i) {
    const double distance = squared_distance(host, i, point);
    const GlobalIndex candidate = map.getGlobalElement(static_cast<LocalIndex>(i));
    if (distance < least || (distance == least && candidate < id)) {
      least = distance;
      id = candidate;
      local = static_cast<LocalIndex>(i);
    }
  }
  NearestParticle nearest;
  const double global_least = minimum(communicator, least);
  if (!std::isfinite(global_least)) return nearest;
  nearest.distance = std::sqrt(global_least);
  const GlobalIndex mine = least == global_least ? id : none;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, 1, &mine, &nearest.id);
  const bool is_mine = mine == nearest.id;
  const int rank = is_mine ? communicator.getRank() : -1;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 1, &rank, &nearest.rank);
  if (is_mine) {
    nearest.local = local;
    for (std::size_t d = 0; d < 3; ++d) nearest.position[d] = host(static_cast<std::size_t>(local), d);
  }
  Teuchos::broadcast(communicator, nearest.rank, 3, nearest.position.data());
  Teuchos::broadcast(communicator, nearest.rank, 1, &nearest.local);

  double gap = infinite;
  for (std::size_t i = 0; i < host.extent(0); ++i) {
    const bool itself = is_mine && static_cast<LocalIndex>(i) == local;
    if (!itself) gap = std::min(gap, squared_distance(host, i, nearest.position));
  }
  gap = minimum(communicator, gap);
  nearest.spacing = std::isfinite(gap) ? std::sqrt(gap) : 0.0;
  return nearest;
}

std::array<std::array<double, 3>, 2> bounding_box(ConstPositionView positions, const Communicator& communicator) {
  const HostPositions host = on_host(positions);
  std::array<double, 3> lower, upper;
  lower.fill(infinite);
  upper.fill(-infinite);
  for (std::size_t i = 0; i < host.extent(0); ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = std::min(lower[d], host(i, d));
      upper[d] = std::max(upper[d], host(i, d));
    }
  }
  std::array<std::array<double, 3>, 2> box{};
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, 3, lower.data(), box[0].data());
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 3, upper.data(), box[1].data());
  return box;
}

}  // namespace kiln
