#pragma once

#include <string>

#include "rom/clustering/SourceClustering.hpp"

namespace kiln {

/// Clusters that are far enough from the rows that use them at every moment of the training. A tree of the
/// trajectories, for each sign of the weights one, cuts a node across its widest direction half way. A row takes a node
/// where at all moments the widest side of the box around its members is less than `opening` times the distance from
/// the row to their mean, or than √(distance² + smooth²), where pair terms are regular at short distance. Means are
/// weighted by |w|, so that a cluster's first moment is its members': what is left is of second order in size/distance.
/// Instead of an opening, `clusters` may be given: each row then takes the smallest opening, of a fine grid of them,
/// that gives it at most so many, and the online cost does not grow with the particles. For weights that do not depend
/// on the row.
class CertifiedClusters : public SourceClustering {
 public:
  static Specification specification();
  CertifiedClusters(const Teuchos::ParameterList& list, const NoContext&);

  SourceClusters clusters(const PairWeights& pairs, const SourceMotion& motion) const override;
  bool needs_shared_sources() const override { return true; }
  std::optional<WeightFit> weight_fit() const override { return weight_fit_; }

 private:
  std::string path_;
  double opening_;
  std::size_t most_;  ///< clusters of a row; 0: as many as the opening gives
  double smooth_;
  std::size_t leaf_;
  std::optional<WeightFit> weight_fit_;
};

}  // namespace kiln
