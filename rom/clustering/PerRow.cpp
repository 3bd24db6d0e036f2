#include "rom/clustering/PerRow.hpp"

#include <cmath>

#include "rom/clustering/Partition.hpp"

namespace kiln {
namespace {

/// Parts of a row's pairs, by their numbers.
std::vector<std::vector<std::size_t>> parts_of_row(const PairWeights& pairs, std::size_t row,
                                                   const SourceMotion& motion, std::size_t most) {
  std::vector<std::size_t> numbers, places, itself;
  std::vector<double> weights;
  std::vector<std::vector<std::size_t>> signs(2);
  for (std::size_t pair = pairs.offsets[row]; pair < pairs.offsets[row + 1]; ++pair) {
    if (pairs.weights[pair] == 0.0) continue;
    if (pairs.sources[pair] == pairs.rows[row]) {
      itself.push_back(pair);
      continue;
    }
    signs[pairs.weights[pair] > 0.0 ? 0 : 1].push_back(numbers.size());
    numbers.push_back(pair);
    places.push_back(motion.place(pairs.sources[pair]));
    weights.push_back(std::abs(pairs.weights[pair]));
  }
  std::vector<std::vector<std::size_t>> parts;
  if (!itself.empty()) parts.push_back(itself);
  if (numbers.size() <= most) {
    for (const std::size_t pair : numbers) parts.push_back({pair});
    return parts;
  }
  for (std::vector<std::size_t>& part : partition(trajectories(motion, places), weights, signs, most)) {
    for (std::size_t& member : part) member = numbers[member];
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

Specification PerRow::specification() {
  Specification s;
  s.integer("clusters", "most clusters of a row's sources; multiples of 8 fill the lanes of vectors")
      .at_least(1)
      .defaults_to(8);
  WeightFit::specify(s, "fitted");
  return s;
}

PerRow::PerRow(const Teuchos::ParameterList& list, const NoContext&)
    : most_(list.get<int>("clusters")), weight_fit_(WeightFit::of(list)) {}

SourceClusters PerRow::clusters(const PairWeights& pairs, const SourceMotion& motion) const {
  SourceClusters result;
  result.rows = pairs.rows;
  result.row_offsets = result.member_offsets = {0};
  for (std::size_t row = 0; row < pairs.rows.size(); ++row) {
    for (const std::vector<std::size_t>& part : parts_of_row(pairs, row, motion, most_)) {
      double weight = 0.0;
      for (const std::size_t pair : part) weight += pairs.weights[pair];
      for (const std::size_t pair : part) {
        result.members.push_back(pairs.sources[pair]);
        result.shares.push_back(pairs.weights[pair] / weight);
      }
      result.row_clusters.push_back(result.clusters());
      result.row_weights.push_back(weight);
      result.member_offsets.push_back(result.members.size());
    }
    result.row_offsets.push_back(result.row_clusters.size());
  }
  return result;
}

KILN_REGISTER(SourceClustering, PerRow, "per row",
              "clusters of each row's own, for short sums with weights of their own (SPH)");

}  // namespace kiln
