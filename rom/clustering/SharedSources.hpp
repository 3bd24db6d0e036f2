#pragma once

#include <string>
#include <vector>

#include "framework/model/PairwiseModel.hpp"

namespace kiln {

/// The sources of pairs that all rows share: each row sums over every source with the weight that is the source's own,
/// as a vortex' circulation is.
struct SharedSources {
  std::vector<GlobalIndex> ids;  ///< ascending
  std::vector<double> weights;   ///< one a source
  std::vector<bool> own;         ///< of each row: whether it is among its own sources

  /// Throws InputError, naming the clustering at `path`, for weights that depend on the row and for a row that lacks a
  /// source other than itself.
  SharedSources(const PairWeights& pairs, const std::string& path);
};

}  // namespace kiln
