#pragma once

#include <string>

#include "rom/clustering/SourceClustering.hpp"

namespace kiln {

/// The clustering of Appendix A of NRL/6390/MR--2022/1 as we read it. The modes are superposed by their singular
/// values,
///
///     X = u_begin + Σ_k (σ_k/σ_1) Φ[:, k],
///
/// one place a particle in as many dimensions as it has components. A tree halves the box around all X in each of them
/// until a cell holds `leaf` particles, and a row takes a cell where its side is less than `opening` times the distance
/// from the row to the mean of its members (Barnes, Hut 1986). A cluster's state is the plain mean of its members', its
/// weight the sum of theirs. For weights that do not depend on the row.
class SuperposedModes : public SourceClustering {
 public:
  static Specification specification();
  SuperposedModes(const Teuchos::ParameterList& list, const NoContext&);

  SourceClusters clusters(const PairWeights& pairs, const SourceMotion& motion) const override;
  bool needs_shared_sources() const override { return true; }
  std::optional<WeightFit> weight_fit() const override { return std::nullopt; }

 private:
  std::string path_;
  double opening_;
  std::size_t leaf_;
};

}  // namespace kiln
