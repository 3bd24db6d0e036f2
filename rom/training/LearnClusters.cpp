#include "rom/training/LearnClusters.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>

#include "framework/base/Error.hpp"
#include "rom/clustering/SharedSources.hpp"
#include "rom/clustering/SourceClustering.hpp"
#include "rom/linear_algebra/Dense.hpp"
#include "rom/training/FitWeights.hpp"

namespace kiln {
namespace {

const PairwiseModel& pairwise(const Model& model, const Teuchos::ParameterList& block) {
  const auto* offered = dynamic_cast<const PairwiseModel*>(&model);
  if (offered != nullptr) return *offered;
  throw InputError(block.name(), "this model does not tell the pairs that its rate is a sum of",
                   "a model that does, such as 'sph heat', or no source clustering");
}

/// Rows of the bases, positions and u_ref at all particles that occur in pairs.
ParticleTable table_of(const PairWeights& pairs, const Model& model, const VectorView& reference,
                       const std::vector<WindowReduction>& windows) {
  std::vector<GlobalIndex> ids = pairs.rows;
  ids.insert(ids.end(), pairs.sources.begin(), pairs.sources.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<MatrixView> modes;
  for (const WindowReduction& window : windows) modes.push_back(window.basis.modes);
  return ParticleTable::gather(ids, *model.rows(), model.positions(), reference, modes,
                               static_cast<int>(model.fields().size()));
}

SourceMotion motion_of(const ParticleTable& table, const Pod& basis, const std::vector<VectorView>& moments) {
  const VectorView reference = table.reference_entries();
  const MatrixView modes = table.mode_entries();
  const std::size_t columns = modes.extent(1), rank = basis.truncation.rank;
  SourceMotion motion{table.ids, table.components, {}, {}, {}, {}};
  motion.states = MatrixView("kiln::rom::states at moments", reference.extent(0), moments.size());
  for (std::size_t moment = 0; moment < moments.size(); ++moment) {
    const VectorView state = Kokkos::subview(motion.states, Kokkos::ALL, moment);
    Kokkos::deep_copy(state, reference);
    // Windows to come have no modes yet, and their coordinates are zero.
    const ConstVectorView known = Kokkos::subview(moments[moment], std::make_pair(std::size_t(0), columns));
    dense::multiply(1.0, modes, known, 1.0, state);
  }
  motion.beginning = Kokkos::subview(motion.states, Kokkos::ALL, 0);
  motion.modes = Kokkos::subview(modes, Kokkos::ALL, std::make_pair(columns - rank, columns));
  motion.singular_values.assign(basis.singular_values.begin(),
                                basis.singular_values.begin() + static_cast<std::ptrdiff_t>(rank));
  return motion;
}

/// Means over the members' rows of a table with `width` values a particle.
std::vector<double> means(const SourceClusters& clusters, const std::vector<std::size_t>& places,
                          const std::vector<double>& values, std::size_t width) {
  std::vector<double> result(clusters.clusters() * width, 0.0);
  for (std::size_t cluster = 0; cluster < clusters.clusters(); ++cluster) {
    for (std::size_t m = clusters.member_offsets[cluster]; m < clusters.member_offsets[cluster + 1]; ++m) {
      for (std::size_t k = 0; k < width; ++k) {
        result[cluster * width + k] += clusters.shares[m] * values[places[m] * width + k];
      }
    }
  }
  return result;
}

ParticleTable table_of_clusters(const SourceClusters& clusters, const ParticleTable& table, GlobalIndex first_id) {
  const std::size_t count = clusters.clusters(), components = table.components, width = table.modes.shape[1];
  std::vector<std::size_t> places;
  for (const GlobalIndex id : clusters.members) places.push_back(static_cast<std::size_t>(table.find(id)));
  ParticleTable result;
  for (std::size_t cluster = 0; cluster < count; ++cluster) {
    result.ids.push_back(first_id + static_cast<GlobalIndex>(cluster));
  }
  result.components = table.components;
  result.positions = means(clusters, places, table.positions, 3);
  result.reference = {{count, components}, means(clusters, places, table.reference.values, components)};
  result.modes = {{count, width}, means(clusters, places, table.modes.values, width)};
  return result;
}

}  // namespace

void check_clustering(const Teuchos::ParameterList& block, const Model& model) {
  const PairwiseModel& pairs = pairwise(model, block);
  if (!Registry<SourceClustering>::create(block, NoContext{})->needs_shared_sources()) return;
  const Map& rows = *model.rows();
  std::vector<GlobalIndex> ends{rows.getMinAllGlobalIndex(), rows.getMaxAllGlobalIndex()};
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  SharedSources(pairs.pair_weights(ends), block.name());
}

std::vector<int> clustering_steps(const Teuchos::ParameterList& block, int first, int last) {
  const int count = std::min(last - first, Registry<SourceClustering>::create(block, NoContext{})->most_moments());
  std::vector<int> steps;
  for (int k = 1; k <= count; ++k) {
    steps.push_back(first + static_cast<int>(static_cast<long long>(last - first) * k / count));
  }
  return steps;
}

ClusteredMesh learn_clusters(const Teuchos::ParameterList& block, const Model& model, const VectorView& reference,
                             const std::vector<WindowReduction>& windows, const LearntStates& states) {
  const PairwiseModel& pairwise_model = pairwise(model, block);
  const WindowReduction& window = windows.back();
  const PairWeights pairs = pairwise_model.pair_weights(window.sampled);
  const ParticleTable table = table_of(pairs, model, reference, windows);
  ClusteredMesh mesh;
  mesh.type = block.get<std::string>("type");
  const auto clustering = Registry<SourceClustering>::create(block, NoContext{});
  mesh.clusters = clustering->clusters(pairs, motion_of(table, window.basis, states.coordinates));
  mesh.table = table_of_clusters(mesh.clusters, table, model.rows()->getMaxAllGlobalIndex() + 1);
  if (const auto fit = clustering->weight_fit()) {
    fit_weights(pairwise_model, *window.sample, table, mesh.table, states, *fit, mesh.clusters);
  }
  mesh.model = pairwise_model.clustered(mesh.clusters);
  mesh.unclustered_pairs = pairs.sources.size();
  return mesh;
}

}  // namespace kiln
