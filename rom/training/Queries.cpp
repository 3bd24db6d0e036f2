#include "rom/training/Queries.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <limits>

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
  const Teuchos::RCP<const Map> rows = model.rows();
  const ConstPositionView particles = model.positions();
  const std::size_t local = rows->getMyGlobalIndices().extent(0), count = positions.size();
  const auto distance = [&](std::size_t particle, std::size_t position) {
    double sum = 0.0;
    for (int d = 0; d < 3; ++d) {
      const double difference = particles(particle, d) - positions[position][d];
      sum += difference * difference;
    }
    return sum;
  };
  std::vector<double> mine(count, std::numeric_limits<double>::infinity()), least(count);
  for (std::size_t q = 0; q < count; ++q) {
    for (std::size_t i = 0; i < local; ++i) mine[q] = std::min(mine[q], distance(i, q));
  }
  Teuchos::reduceAll(*rows->getComm(), Teuchos::REDUCE_MIN, static_cast<int>(count), mine.data(), least.data());
  std::vector<GlobalIndex> candidates(count, std::numeric_limits<GlobalIndex>::max()), ids(count);
  for (std::size_t q = 0; q < count; ++q) {
    for (std::size_t i = 0; i < local && mine[q] == least[q]; ++i) {
      if (distance(i, q) == least[q]) {
        candidates[q] = std::min(candidates[q], rows->getGlobalElement(static_cast<LocalIndex>(i)));
      }
    }
  }
  Teuchos::reduceAll(*rows->getComm(), Teuchos::REDUCE_MIN, static_cast<int>(count), candidates.data(), ids.data());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace kiln
