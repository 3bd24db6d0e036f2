#pragma once

#include <optional>
#include <vector>

#include "framework/model/PairwiseModel.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {

/// What the particles that pairs speak of do in one time window of a training; the same on every rank. Arrays hold
/// `components` values a particle, particle by particle.
struct SourceMotion {
  std::vector<GlobalIndex> ids;  ///< all rows and sources, ascending
  int components;
  VectorView beginning;                 ///< the state in which the window begins: u_ref in the first one
  MatrixView modes;                     ///< Φ of the window
  std::vector<double> singular_values;  ///< σ, one a mode
  MatrixView states;                    ///< states at moments of the window, one a column, the beginning first

  /// Place of a particle in ids. Throws std::logic_error for one that is not there.
  std::size_t place(GlobalIndex id) const;
};

/// How fit_weights() changes the weights that clusters come with.
struct WeightFit {
  double ridge;          ///< how strongly weights hold to what they are drawn to, relative to what clusters bring
  std::size_t most = 0;  ///< clusters that a row keeps, chosen one after the other; 0: all

  /// Near the sums of their members' weights, such that rates come out right in the mean.
  static WeightFit near_sums() { return {0.1}; }

  /// The key `weights` of a clustering: sums or fitted.
  static void specify(Specification& specification, const char* if_left_out);
  /// What that key says; nothing: the sums as they are.
  static std::optional<WeightFit> of(const Teuchos::ParameterList& list);
};

/// Gathers the many sources of each sampled row into few weighted ones (PTROM, Appendix A of NRL/6390/MR--2022/1).
/// Knows no physics: what pairs weigh and how particles move is all there is.
class SourceClustering {
 public:
  using Context = NoContext;
  static constexpr const char* category = "source clustering";

  virtual ~SourceClustering() = default;
  /// Clusters for pairs.rows; those of a row ascend. Does not depend on the order of round-off by which the arguments
  /// of different numbers of ranks differ. Throws InputError for pairs it does not serve.
  virtual SourceClusters clusters(const PairWeights& pairs, const SourceMotion& motion) const = 0;
  /// Whether it serves only pairs whose sources weigh the same in every row (SharedSources).
  virtual bool needs_shared_sources() const = 0;
  /// How training is to fit row_weights to the rates that it has met; nothing: not at all.
  virtual std::optional<WeightFit> weight_fit() const = 0;
  /// How many states of a window, besides its beginning, training shows to clusters() and to the fit at most. Fifty
  /// tell how far particles come.
  virtual int most_moments() const { return 50; }
};

}  // namespace kiln
