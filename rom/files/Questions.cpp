#include "rom/files/Questions.hpp"

#include <algorithm>
#include <cmath>

namespace kiln {
namespace {

/// Of the spacing: what is nearer to a position that was asked about is that position.
constexpr double same_place = 1e-6;

}  // namespace

std::vector<GlobalIndex> Questions::particles() const {
  std::vector<GlobalIndex> ids = nearest;
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

bool Questions::tells(const std::array<double, 3>& point, double distance) const {
  // Half way between two particles both are nearest.
  if (distance < (0.5 - same_place) * spacing) return true;
  return std::any_of(positions.begin(), positions.end(), [&](const std::array<double, 3>& asked) {
    return std::hypot(point[0] - asked[0], point[1] - asked[1], point[2] - asked[2]) <= same_place * spacing;
  });
}

void Questions::write(hdf5::Group& group) const {
  hdf5::Array<double> asked{{positions.size(), 3}, {}};
  for (const std::array<double, 3>& position : positions) {
    asked.values.insert(asked.values.end(), position.begin(), position.end());
  }
  group.write("asked", asked);
  group.write("nearest", std::vector<long long>(nearest.begin(), nearest.end()));
  group.attribute("spacing", spacing);
}

Questions Questions::read(const hdf5::Group& group) {
  const hdf5::Array<double> asked = group.finite_reals("asked", {0, 3});
  const hdf5::Array<long long> nearest = group.integers("nearest", {asked.shape[0]});
  Questions questions;
  for (std::size_t k = 0; k < asked.shape[0]; ++k) {
    questions.positions.push_back({asked.values[3 * k], asked.values[3 * k + 1], asked.values[3 * k + 2]});
  }
  questions.nearest.assign(nearest.values.begin(), nearest.values.end());
  questions.spacing = group.finite_real("spacing");
  return questions;
}

}  // namespace kiln
