#pragma once

#include <string>

#include "rom/clustering/SourceClustering.hpp"

namespace kiln {

/// No particle beside the sampled ones: each row's sum over its many sources becomes one over few of the other rows,
///
///     Σ_j w_ij g(u_i, u_j)  ≈  Σ_{c ∈ S_i} z_ic g(u_i, u_c),   S_i ⊂ rows.
///
/// That this can be: what the sources do in a window lies in M dimensions, and gappy reconstruction works because the
/// sampled rows tell all of them. A sum that is linear in the sources' states is linear in M numbers, which M rows
/// determine. What is left is of the pair term's curvature and of states that training has not met. Which rows serve
/// and with what weights is found from the rates of the training (fit_weights()); offered here are all of them.
class AmongSamples : public SourceClustering {
 public:
  static Specification specification();
  AmongSamples(const Teuchos::ParameterList& list, const NoContext&);

  /// Each row's other rows as clusters of one member. Throws InputError for a single row.
  SourceClusters clusters(const PairWeights& pairs, const SourceMotion& motion) const override;
  bool needs_shared_sources() const override { return false; }
  std::optional<WeightFit> weight_fit() const override { return fit_; }
  /// A row's weights must have seen all modes that pass it, also where one basis serves a whole run.
  int most_moments() const override { return 400; }

 private:
  std::string path_;
  WeightFit fit_;
};

}  // namespace kiln
