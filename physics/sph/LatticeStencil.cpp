#include "physics/sph/LatticeStencil.hpp"

#include <algorithm>
#include <cmath>

namespace kiln {
namespace {

/// Parts of a spacing that a particle may be off its place: far above rounding, far below what a weight would show.
constexpr double tolerance = 1e-9;

/// Layers of particles along an axis.
struct Layers {
  double lower;
  double spacing;
  LocalIndex count;
};

std::optional<Layers> layers_along(const std::vector<Point>& positions, int axis, double support) {
  std::vector<double> coordinates;
  coordinates.reserve(positions.size());
  for (const Point& position : positions) coordinates.push_back(position[axis]);
  std::sort(coordinates.begin(), coordinates.end());
  const double lower = coordinates.front();
  // What lies closer together than this is one layer, or no lattice.
  const double gap = 1e-6 * support;
  LocalIndex count = 1;
  for (std::size_t i = 1; i < coordinates.size(); ++i) count += coordinates[i] - coordinates[i - 1] > gap ? 1 : 0;
  if (count == 1)
    return coordinates.back() - lower <= tolerance * support ? std::optional(Layers{lower, support, 1}) : std::nullopt;
  const double spacing = (coordinates.back() - lower) / (count - 1);
  for (const double coordinate : coordinates) {
    const double place = (coordinate - lower) / spacing;
    if (std::abs(place - std::round(place)) > tolerance) return std::nullopt;
  }
  return Layers{lower, spacing, count};
}

}  // namespace

LatticePlace LatticeStencil::place(const Point& position) const {
  LatticePlace result;
  for (int axis = 0; axis < 3; ++axis) {
    result[axis] = static_cast<LocalIndex>(std::lround((position[axis] - lower[axis]) / spacing[axis]));
  }
  return result;
}

LatticePlace LatticeStencil::original(LatticePlace place) const {
  if (!mirrored) return place;
  for (int axis = 0; axis < 3; ++axis) {
    const LocalIndex period = 2 * layers[axis];
    const LocalIndex within = (place[axis] % period + period) % period;
    place[axis] = std::min(within, period - 1 - within);
  }
  return place;
}

std::optional<LatticeStencil> lattice_stencil(const std::vector<Point>& positions, const Kernel& kernel, double support,
                                              const std::optional<Box>& mirrors) {
  LatticeStencil stencil;
  stencil.mirrored = mirrors.has_value();
  double places = 1.0;
  std::array<LocalIndex, 3> reach{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto layers = layers_along(positions, axis, support);
    if (!layers) return std::nullopt;
    stencil.lower[axis] = layers->lower;
    stencil.layers[axis] = layers->count;
    stencil.spacing[axis] = mirrors ? (mirrors->upper[axis] - mirrors->lower[axis]) / layers->count : layers->spacing;
    if (mirrors && std::abs(stencil.lower[axis] - mirrors->lower[axis] - 0.5 * stencil.spacing[axis]) >
                       tolerance * stencil.spacing[axis]) {
      return std::nullopt;
    }
    places *= layers->count;
    // A part of one layer has neighbours along that axis only in its mirror images.
    reach[axis] =
        layers->count == 1 && !mirrors ? 0 : static_cast<LocalIndex>(std::floor(support / stencil.spacing[axis]));
  }
  constexpr double most_offsets = 1e5;
  if (places > 2.0 * static_cast<double>(positions.size()) ||
      (2.0 * reach[0] + 1.0) * (2.0 * reach[1] + 1.0) * (2.0 * reach[2] + 1.0) > most_offsets) {
    return std::nullopt;
  }
  // As for neighbours: pairs exactly at the support are outside, whatever the rounding.
  const double squared_support = std::pow(support * (1.0 - 1e-10), 2);
  for (LocalIndex z = 0; z <= reach[2]; ++z) {
    for (LocalIndex y = z == 0 ? 0 : -reach[1]; y <= reach[1]; ++y) {
      for (LocalIndex x = z == 0 && y == 0 ? 1 : -reach[0]; x <= reach[0]; ++x) {
        const double square = std::pow(x * stencil.spacing[0], 2) + std::pow(y * stencil.spacing[1], 2) +
                              std::pow(z * stencil.spacing[2], 2);
        if (square >= squared_support) continue;
        const double weight = kernel.gradient_over_distance(std::sqrt(square));
        stencil.offsets.push_back({x, y, z});
        stencil.offsets.push_back({-x, -y, -z});
        stencil.weights.insert(stencil.weights.end(), {weight, weight});
      }
    }
  }
  return stencil;
}

}  // namespace kiln
