#include "rom/training/Queries.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <utility>

#include "framework/observers/NearestParticle.hpp"

namespace kiln {
namespace {

void append_positions(const Teuchos::ParameterList& points, std::vector<std::array<double, 3>>& positions) {
  for (auto point = points.begin(); point != points.end(); ++point) {
    const auto& xyz = points.sublist(points.name(point)).get<Teuchos::Array<double>>("position");
    positions.push_back({xyz[0], xyz[1], xyz[2]});
  }
}

}  // namespace

std::vector<std::array<double, 3>> queried_positions(const Teuchos::ParameterList& input) {
  std::vector<std::array<double, 3>> positions;
  if (input.isSublist("output") && input.sublist("output").isSublist("probes")) {
    const Teuchos::ParameterList& probes = input.sublist("output").sublist("probes");
    if (probes.isSublist("points")) append_positions(probes.sublist("points"), positions);
  }
  const Teuchos::ParameterList& reduction = input.sublist("reduction");
  if (reduction.isSublist("queries")) append_positions(reduction.sublist("queries"), positions);
  return positions;
}

std::vector<GlobalIndex> nearest_particles(const Model& model, const std::vector<std::array<double, 3>>& positions) {
  const ConstPositionView rows =
      Kokkos::subview(model.positions(), std::make_pair(LocalIndex(0), local_size(*model.rows())), Kokkos::ALL);
  std::vector<GlobalIndex> ids;
  for (const std::array<double, 3>& position : positions) {
    ids.push_back(nearest_particle(*model.rows(), rows, position).id);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace kiln
