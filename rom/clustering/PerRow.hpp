#pragma once

#include "rom/clustering/SourceClustering.hpp"

namespace kiln {

/// Each row's sources in clusters of its own, for short sums with weights of the row's own, as SPH has them. Sources
/// whose trajectories are alike come together (partition(), weighted by |w_ij|), those of other sign apart and the row
/// itself by itself. With the shares a_m = w_im / Σ w_im of a cluster's members Σ_j w_ij u_j is kept exactly, and so is
/// any rate that is linear in the sources' states. What is left is of second order in the differences within a cluster,
/// and fitted weights (fit_weights()) take the mean of that away.
class PerRow : public SourceClustering {
 public:
  static Specification specification();
  PerRow(const Teuchos::ParameterList& list, const NoContext&);

  SourceClusters clusters(const PairWeights& pairs, const SourceMotion& motion) const override;
  bool needs_shared_sources() const override { return false; }
  std::optional<WeightFit> weight_fit() const override { return weight_fit_; }

 private:
  std::size_t most_;  ///< clusters of a row
  std::optional<WeightFit> weight_fit_;
};

}  // namespace kiln
