#include "rom/training/Queries.hpp"

#include <Teuchos_Array.hpp>
#include <utility>

#include "framework/base/NearestParticle.hpp"

namespace kiln {
namespace {

void append_positions(const Teuchos::ParameterList& points, std::vector<std::array<double, 3>>& positions) {
  for (auto point = points.begin(); point != points.end(); ++point) {
    const auto& xyz = points.sublist(points.name(point)).get<Teuchos::Array<double>>("position");
    positions.push_back({xyz[0], xyz[1], xyz[2]});
  }
}

}  // namespace

Questions questions_of(const Teuchos::ParameterList& input, const Model& model) {
  Questions questions;
  if (input.isSublist("output") && input.sublist("output").isSublist("probes")) {
    const Teuchos::ParameterList& probes = input.sublist("output").sublist("probes");
    if (probes.isSublist("points")) append_positions(probes.sublist("points"), questions.positions);
  }
  const Teuchos::ParameterList& reduction = input.sublist("reduction");
  if (reduction.isSublist("queries")) append_positions(reduction.sublist("queries"), questions.positions);
  const ConstPositionView rows =
      Kokkos::subview(model.positions(), std::make_pair(LocalIndex(0), local_size(*model.rows())), Kokkos::ALL);
  for (const std::array<double, 3>& position : questions.positions) {
    questions.nearest.push_back(nearest_particle(*model.rows(), rows, position).id);
  }
  return questions;
}

}  // namespace kiln
