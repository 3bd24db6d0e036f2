#pragma once

#include <memory>
#include <string>

#include "framework/model/Model.hpp"
#include "framework/model/PairwiseModel.hpp"
#include "rom/files/ParticleRows.hpp"

namespace kiln {

/// The sample mesh of a time window with few weighted sources in place of each row's many.
struct ClusteredMesh {
  std::string type;  ///< of the source clustering
  SourceClusters clusters;
  /// The clusters as particles: mean position, u_ref and modes of this window and those before it. Their ids are those
  /// that PairwiseModel::clustered gives them.
  ParticleTable table;
  std::unique_ptr<Model> model;   ///< on the sampled rows and their clusters
  std::size_t unclustered_pairs;  ///< of the sample mesh: what clusters are measured against

  /// The group `clusters` of a window:
  ///
  ///     attributes   type, pairs, sources (rows and what else they use), unclustered_pairs
  ///     /            ids, positions, reference, modes: of the clusters, as of particles
  ///                  rows, row_offsets, row_clusters, row_weights; member_offsets, members, shares: SourceClusters
  ///     model/       written by the model itself
  ///
  /// Collective.
  void write(hdf5::Group group) const;
};

/// What write() wrote of the clusters. Throws FileError for numbers that do not fit together.
SourceClusters read_clusters(const hdf5::Group& group);

}  // namespace kiln
