#include "physics/sph/Distribution.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <numeric>

#include "physics/sph/Neighbours.hpp"

namespace kiln {
namespace {

int longest_axis(const std::vector<Point>& positions, const std::vector<GlobalIndex>& ids) {
  Point lower = positions[ids.front()];
  Point upper = lower;
  for (const GlobalIndex id : ids) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], positions[id][axis]);
      upper[axis] = std::max(upper[axis], positions[id][axis]);
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    // Rounding must not decide between equal edges.
    if (upper[axis] - lower[axis] > (upper[longest] - lower[longest]) * (1.0 + 1e-9)) longest = axis;
  }
  return longest;
}

}  // namespace

std::vector<double> neighbour_counts(const std::vector<Point>& positions, double radius,
                                     const Communicator& communicator) {
  const auto number = static_cast<LocalIndex>(positions.size());
  const auto first =
      static_cast<LocalIndex>(static_cast<long long>(number) * communicator.getRank() / communicator.getSize());
  const auto last =
      static_cast<LocalIndex>(static_cast<long long>(number) * (communicator.getRank() + 1) / communicator.getSize());
  IndexView targets("targets", last - first);
  Kokkos::parallel_for(
      "kiln::sph::number targets", RangePolicy(0, last - first),
      KOKKOS_LAMBDA(LocalIndex i) { targets(i) = first + i; });
  const auto counts = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(),
                                                          count_neighbours(position_view(positions), targets, radius));
  std::vector<double> own(number, 0.0);
  for (LocalIndex i = first; i < last; ++i) own[i] = static_cast<double>(counts(i - first));
  std::vector<double> all(number);
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, number, own.data(), all.data());
  return all;
}

std::vector<GlobalIndex> coordinate_bisection(const std::vector<Point>& positions, const std::vector<double>& weights,
                                              int parts, int part) {
  std::vector<GlobalIndex> ids(positions.size());
  std::iota(ids.begin(), ids.end(), GlobalIndex{0});
  while (parts > 1 && !ids.empty()) {
    const int axis = longest_axis(positions, ids);
    // Ids settle ties, so that whole lattice planes can be divided.
    std::sort(ids.begin(), ids.end(), [&](GlobalIndex a, GlobalIndex b) {
      return positions[a][axis] != positions[b][axis] ? positions[a][axis] < positions[b][axis] : a < b;
    });
    double total = 0.0;
    for (const GlobalIndex id : ids) total += weights[id];
    const int left = parts / 2;
    const double wanted = total * left / parts;
    std::size_t cut = 0;
    double sum = 0.0;
    while (cut < ids.size() && sum + 0.5 * weights[ids[cut]] < wanted) sum += weights[ids[cut++]];
    if (part < left) {
      ids.resize(cut);
      parts = left;
    } else {
      ids.erase(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(cut));
      parts -= left;
      part -= left;
    }
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace kiln
