#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

class Model;

/// The pairs of chosen rows and their weights, by particle ids, the same on every rank. Row r of the list has the pairs
/// [offsets[r], offsets[r + 1]).
struct PairWeights {
  std::vector<GlobalIndex> rows;     ///< ids, ascending
  std::vector<std::size_t> offsets;  ///< rows + 1
  std::vector<GlobalIndex> sources;  ///< id of each pair's source
  std::vector<double> weights;       ///< w_ij of each pair
};

/// Few weighted sources in place of each row's many. A cluster stands where its members stand in the mean: its state is
/// Σ_m a_m u_m with Σ_m a_m = 1, whatever time it is, so that the rows of a basis average like states. Clusters may
/// serve several rows. The same on every rank.
struct SourceClusters {
  std::vector<GlobalIndex> rows;            ///< ids of the rows that are evaluated, ascending
  std::vector<std::size_t> row_offsets;     ///< rows + 1: where each row's clusters begin
  std::vector<std::size_t> row_clusters;    ///< numbers of the clusters a row sums over
  std::vector<double> row_weights;          ///< w_ic of each of these: the sum of its members' w_ij, or near it
  std::vector<std::size_t> member_offsets;  ///< clusters + 1: where each cluster's members begin
  std::vector<GlobalIndex> members;         ///< ids of the particles in a cluster
  std::vector<double> shares;               ///< a_m of each member

  std::size_t clusters() const { return member_offsets.size() - 1; }
  /// What a cluster is called among the sources of a clustered model of N particles: the id of a row where that is its
  /// only member, N + its number otherwise.
  GlobalIndex source_id(std::size_t cluster, GlobalIndex particles) const {
    const std::size_t first = member_offsets[cluster];
    const bool is_row =
        member_offsets[cluster + 1] == first + 1 && std::binary_search(rows.begin(), rows.end(), members[first]);
    return is_row ? members[first] : particles + static_cast<GlobalIndex>(cluster);
  }
};

/// Offered beside Model by physics whose rate is a sum over pairs of particles and a term of the row's own,
///
///     f_i = Σ_j w_ij g(u_i, u_j; µ) + h_i(u_i, t; µ),
///
/// with weights that stay as they are and a pair term g that is smooth in the source's state. Source clustering (PTROM,
/// Appendix A of NRL/6390/MR--2022/1) works on what this tells and knows no physics.
class PairwiseModel {
 public:
  virtual ~PairwiseModel() = default;

  /// The pairs of some of the model's rows over all ranks. `rows`: ids, the same on every rank. Throws InputError for
  /// an id that is no row. Collective.
  virtual PairWeights pair_weights(const std::vector<GlobalIndex>& rows) const = 0;

  /// The same physics at clusters.rows, each summed over its clusters. As Model::sampled, with these sources: the rows
  /// of a rank, ascending, then what else they use, ascending by SourceClusters::source_id with N one more than the
  /// largest id of the model's rows. With clusters of one member each it is the sampled model, to round-off. Its
  /// save_sample writes what the model is rebuilt from as from a sample. Collective.
  virtual std::unique_ptr<Model> clustered(const SourceClusters& clusters) const = 0;
};

}  // namespace kiln
