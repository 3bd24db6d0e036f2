#pragma once

#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/PairwiseModel.hpp"
#include "physics/vortex/Vortices.hpp"

namespace kiln {

namespace hdf5 {
class Group;
}

/// Which vortices act on which rows, by ids; the same on every rank. Sources are particles, or clusters of them with
/// ids from `particles` on.
struct VortexTable {
  GlobalIndex particles = 0;         ///< N of the whole model
  std::vector<GlobalIndex> rows;     ///< ascending
  std::vector<GlobalIndex> sources;  ///< ascending; the rows among them
  std::vector<double> x, y;          ///< of the sources at t = 0, in m

  /// Γ of the sources in m²/s where each acts on every row; empty where rows have lists.
  std::vector<double> circulations;

  /// Where rows have lists: those of rows[r] are [offsets[r], offsets[r + 1]), ascending by source.
  std::vector<std::size_t> offsets;
  std::vector<GlobalIndex> listed;          ///< id of each pair's source
  std::vector<double> listed_circulations;  ///< of each pair, in m²/s

  bool has_lists() const { return !offsets.empty(); }
  /// Index of a row or a source; throws InputError for an id that is none.
  std::size_t row(GlobalIndex id) const;
  std::size_t source(GlobalIndex id) const;
};

/// All particles, each acting on every other. Throws InputError that names `path` for a cloud without particles and for
/// values that are not finite.
VortexTable whole_table(const VortexCloud& cloud, const std::string& path);

/// Chosen rows of a table without lists. Throws InputError for a row it does not have or that is listed twice.
VortexTable sampled_table(const VortexTable& table, const std::vector<GlobalIndex>& rows);

/// The rows of `clusters`, each with its list. Throws InputError for clusters that do not fit together or to the table,
/// which has no lists itself.
VortexTable clustered_table(const VortexTable& table, const SourceClusters& clusters);

/// w_ij = Γ_j of every other particle j, for chosen rows of a table without lists. Throws as sampled_table.
PairWeights vortex_pair_weights(const VortexTable& table, const std::vector<GlobalIndex>& rows);

/// Collective.
void save_table(const VortexTable& table, hdf5::Group& group);
/// Throws FileError for data that do not fit together. Collective.
VortexTable restored_table(const hdf5::Group& group);

}  // namespace kiln
