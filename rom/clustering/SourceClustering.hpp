#pragma once

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
  /// Whether training is to fit row_weights to the rates that it has met (fit_weights()).
  virtual bool weights_are_fitted() const = 0;
};

}  // namespace kiln
