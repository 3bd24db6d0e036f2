#include "physics/sph/Neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace kiln {
namespace {

/// Particles sorted into the cells of a grid whose edges are at least the search radius.
struct CellGrid {
  double lower[3];
  double inverse_edge;
  LocalIndex cells[3];
  IndexView first;      ///< first entry of each cell in `particles`, plus the end
  IndexView particles;  ///< cell by cell

  KOKKOS_INLINE_FUNCTION LocalIndex along(int axis, double coordinate) const {
    const auto cell = static_cast<LocalIndex>((coordinate - lower[axis]) * inverse_edge);
    return cell < cells[axis] ? cell : cells[axis] - 1;
  }
  KOKKOS_INLINE_FUNCTION LocalIndex number(LocalIndex i, LocalIndex j, LocalIndex k) const {
    return i + cells[0] * (j + cells[1] * k);
  }
};

CellGrid make_grid(const ConstPositionView& positions, double radius) {
  const auto number = static_cast<LocalIndex>(positions.extent(0));
  CellGrid grid;
  double extent[3];
  for (int axis = 0; axis < 3; ++axis) {
    double lower = 0.0;
    double upper = 0.0;
    if (number > 0) {
      Kokkos::parallel_reduce(
          "kiln::sph::bounds", RangePolicy(0, number),
          KOKKOS_LAMBDA(LocalIndex i, double& low, double& high) {
            low = positions(i, axis) < low ? positions(i, axis) : low;
            high = positions(i, axis) > high ? positions(i, axis) : high;
          },
          Kokkos::Min<double>(lower), Kokkos::Max<double>(upper));
    }
    grid.lower[axis] = lower;
    extent[axis] = upper - lower;
  }
  // Few particles in a large box: wider cells keep the grid as small as the cloud.
  double edge = radius;
  const double most_cells = 4.0 * number + 64.0;
  const auto cells = [&](int axis) { return std::floor(extent[axis] / edge) + 1.0; };
  while (cells(0) * cells(1) * cells(2) > most_cells) edge *= 1.25;
  grid.inverse_edge = 1.0 / edge;
  for (int axis = 0; axis < 3; ++axis) grid.cells[axis] = static_cast<LocalIndex>(cells(axis));

  const LocalIndex all_cells = grid.cells[0] * grid.cells[1] * grid.cells[2];
  grid.first = IndexView("cell starts", all_cells + 1);
  grid.particles = IndexView("particles of cells", number);
  IndexView cell("cell of particle", number);
  IndexView filled("cell fill", all_cells);
  const CellGrid g = grid;
  Kokkos::parallel_for(
      "kiln::sph::count cells", RangePolicy(0, number), KOKKOS_LAMBDA(LocalIndex p) {
        cell(p) = g.number(g.along(0, positions(p, 0)), g.along(1, positions(p, 1)), g.along(2, positions(p, 2)));
        Kokkos::atomic_increment(&g.first(cell(p)));
      });
  Kokkos::parallel_scan(
      "kiln::sph::scan cells", RangePolicy(0, all_cells + 1), KOKKOS_LAMBDA(LocalIndex c, LocalIndex & sum, bool last) {
        const LocalIndex count = c < all_cells ? g.first(c) : 0;
        if (last) g.first(c) = sum;
        sum += count;
      });
  Kokkos::parallel_for(
      "kiln::sph::fill cells", RangePolicy(0, number), KOKKOS_LAMBDA(LocalIndex p) {
        g.particles(g.first(cell(p)) + Kokkos::atomic_fetch_add(&filled(cell(p)), 1)) = p;
      });
  return grid;
}

/// Calls visit(neighbour) for each neighbour of a particle, in no order that matters.
template <class Visit>
KOKKOS_INLINE_FUNCTION void for_each_neighbour(const CellGrid& grid, const ConstPositionView& positions, LocalIndex p,
                                               double squared_radius, const Visit& visit) {
  const double x = positions(p, 0);
  const double y = positions(p, 1);
  const double z = positions(p, 2);
  const LocalIndex i = grid.along(0, x);
  const LocalIndex j = grid.along(1, y);
  const LocalIndex k = grid.along(2, z);
  for (LocalIndex c = k > 0 ? k - 1 : 0; c <= k + 1 && c < grid.cells[2]; ++c) {
    for (LocalIndex b = j > 0 ? j - 1 : 0; b <= j + 1 && b < grid.cells[1]; ++b) {
      for (LocalIndex a = i > 0 ? i - 1 : 0; a <= i + 1 && a < grid.cells[0]; ++a) {
        const LocalIndex cell = grid.number(a, b, c);
        for (LocalIndex entry = grid.first(cell); entry < grid.first(cell + 1); ++entry) {
          const LocalIndex q = grid.particles(entry);
          const double dx = x - positions(q, 0);
          const double dy = y - positions(q, 1);
          const double dz = z - positions(q, 2);
          if (q != p && dx * dx + dy * dy + dz * dz < squared_radius) visit(q);
        }
      }
    }
  }
}

double squared_search_radius(double radius) {
  const double inside = radius * (1.0 - 1e-10);
  return inside * inside;
}

/// Shell sort: rows are short and nearly sorted already.
KOKKOS_INLINE_FUNCTION void sort_row(LocalIndex* row, LocalIndex length) {
  constexpr LocalIndex gaps[] = {301, 132, 57, 23, 10, 4, 1};
  for (const LocalIndex gap : gaps) {
    for (LocalIndex i = gap; i < length; ++i) {
      const LocalIndex value = row[i];
      LocalIndex at = i;
      for (; at >= gap && row[at - gap] > value; at -= gap) row[at] = row[at - gap];
      row[at] = value;
    }
  }
}

OffsetView count(const CellGrid& grid, const ConstPositionView& positions, const ConstIndexView& targets,
                 double squared_radius) {
  OffsetView counts("neighbour counts", targets.extent(0) + 1);
  Kokkos::parallel_for(
      "kiln::sph::count neighbours", RangePolicy(0, static_cast<LocalIndex>(targets.extent(0))),
      KOKKOS_LAMBDA(LocalIndex t) {
        std::size_t found = 0;
        for_each_neighbour(grid, positions, targets(t), squared_radius, [&found](LocalIndex) { ++found; });
        counts(t) = found;
      });
  return counts;
}

}  // namespace

OffsetView count_neighbours(ConstPositionView positions, ConstIndexView targets, double radius) {
  return count(make_grid(positions, radius), positions, targets, squared_search_radius(radius));
}

NeighbourList find_neighbours(ConstPositionView positions, ConstIndexView targets, double radius) {
  const CellGrid grid = make_grid(positions, radius);
  const double squared_radius = squared_search_radius(radius);
  const auto number = static_cast<LocalIndex>(targets.extent(0));
  const OffsetView offsets = count(grid, positions, targets, squared_radius);
  std::size_t total = 0;
  Kokkos::parallel_scan(
      "kiln::sph::scan neighbours", RangePolicy(0, number + 1),
      KOKKOS_LAMBDA(LocalIndex t, std::size_t & sum, bool last) {
        const std::size_t found = t < number ? offsets(t) : 0;
        if (last) offsets(t) = sum;
        sum += found;
      },
      total);
  const IndexView neighbours(Kokkos::view_alloc(Kokkos::WithoutInitializing, "neighbours"), total);
  Kokkos::parallel_for(
      "kiln::sph::fill neighbours", RangePolicy(0, number), KOKKOS_LAMBDA(LocalIndex t) {
        LocalIndex* row = neighbours.data() + offsets(t);
        LocalIndex filled = 0;
        for_each_neighbour(grid, positions, targets(t), squared_radius,
                           [row, &filled](LocalIndex q) { row[filled++] = q; });
        sort_row(row, filled);
      });
  return {offsets, neighbours};
}

std::optional<std::pair<LocalIndex, LocalIndex>> coincident_pair(ConstPositionView positions, ConstIndexView targets,
                                                                 const NeighbourList& list, double radius) {
  const double squared_limit = 1e-18 * radius * radius;
  const auto host_positions = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), positions);
  const auto host_targets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), targets);
  const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), list.offsets);
  const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), list.neighbours);
  for (std::size_t t = 0; t < targets.extent(0); ++t) {
    for (std::size_t entry = offsets(t); entry < offsets(t + 1); ++entry) {
      double square = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        square += std::pow(host_positions(host_targets(t), axis) - host_positions(neighbours(entry), axis), 2);
      }
      if (square < squared_limit) return std::make_pair(static_cast<LocalIndex>(t), neighbours(entry));
    }
  }
  return std::nullopt;
}

PositionView position_view(const std::vector<Point>& positions) {
  PositionView view(Kokkos::view_alloc(Kokkos::WithoutInitializing, "positions"), positions.size());
  const auto host = Kokkos::create_mirror_view(view);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) host(i, axis) = positions[i][axis];
  }
  Kokkos::deep_copy(view, host);
  return view;
}

}  // namespace kiln
