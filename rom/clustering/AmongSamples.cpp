#include "rom/clustering/AmongSamples.hpp"

#include <fmt/format.h>

#include <cmath>

#include "framework/base/Error.hpp"

namespace kiln {

Specification AmongSamples::specification() {
  Specification s;
  s.integer("sources", "most sources of a row").at_least(1).defaults_to(12);
  s.real("ridge",
         "how strongly the fit of weights holds to small ones: more is steadier away from the training, less is closer "
         "to it")
      .at_least(1e-6)
      .defaults_to(0.005);
  return s;
}

AmongSamples::AmongSamples(const Teuchos::ParameterList& list, const NoContext&)
    : path_(list.name()), fit_{list.get<double>("ridge"), static_cast<std::size_t>(list.get<int>("sources"))} {}

SourceClusters AmongSamples::clusters(const PairWeights& pairs, const SourceMotion&) const {
  const std::size_t rows = pairs.rows.size();
  if (rows < 2) {
    throw InputError(path_, fmt::format("{} particle is sampled, and has no others for sources", rows),
                     "two sampled particles at least, or another source clustering");
  }
  SourceClusters result;
  result.rows = result.members = pairs.rows;
  result.shares.assign(rows, 1.0);
  result.row_offsets = result.member_offsets = {0};
  for (std::size_t row = 0; row < rows; ++row) {
    double scale = 0.0;
    for (std::size_t pair = pairs.offsets[row]; pair < pairs.offsets[row + 1]; ++pair) {
      scale += std::abs(pairs.weights[pair]);
    }
    for (std::size_t other = 0; other < rows && scale > 0.0; ++other) {
      if (other == row) continue;
      result.row_clusters.push_back(other);
      result.row_weights.push_back(scale);
    }
    result.row_offsets.push_back(result.row_clusters.size());
    result.member_offsets.push_back(row + 1);
  }
  return result;
}

KILN_REGISTER(SourceClustering, AmongSamples, "among samples",
              "few of the other sampled particles for each row, with fitted weights; no further particle is evaluated");

}  // namespace kiln
