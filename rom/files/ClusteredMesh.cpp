#include "rom/files/ClusteredMesh.hpp"

#include <algorithm>
#include <set>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

template <class T>
std::vector<long long> integers(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

/// Places at which the parts of a list of `total` entries begin, one more than there are parts.
std::vector<std::size_t> read_offsets(const hdf5::Group& group, const char* name, std::size_t total) {
  const std::vector<long long> values = group.integers(name, {0}).values;
  if (values.empty() || values.front() != 0 || !std::is_sorted(values.begin(), values.end()) ||
      values.back() != static_cast<long long>(total)) {
    throw FileError(group.file(), group.path() + "/" + name, "does not fit the clusters",
                    "a rise from 0 to " + std::to_string(total));
  }
  return {values.begin(), values.end()};
}

/// Rows and what else they use.
std::size_t source_count(const SourceClusters& clusters) {
  // Any number of particles will do that no row's id reaches.
  const GlobalIndex particles = clusters.rows.empty() ? 0 : clusters.rows.back() + 1;
  std::set<GlobalIndex> ids(clusters.rows.begin(), clusters.rows.end());
  for (const std::size_t cluster : clusters.row_clusters) ids.insert(clusters.source_id(cluster, particles));
  return ids.size();
}

}  // namespace

void ClusteredMesh::write(hdf5::Group group) const {
  group.attribute("type", type);
  group.attribute("pairs", static_cast<long long>(clusters.row_clusters.size()));
  group.attribute("sources", static_cast<long long>(source_count(clusters)));
  group.attribute("unclustered_pairs", static_cast<long long>(unclustered_pairs));
  table.write(group);
  group.write("rows", integers(clusters.rows));
  group.write("row_offsets", integers(clusters.row_offsets));
  group.write("row_clusters", integers(clusters.row_clusters));
  group.write("row_weights", clusters.row_weights);
  group.write("member_offsets", integers(clusters.member_offsets));
  group.write("members", integers(clusters.members));
  group.write("shares", clusters.shares);
  hdf5::Group written = group.create_group("model");
  model->save_sample(written);
}

SourceClusters read_clusters(const hdf5::Group& group) {
  SourceClusters clusters;
  const std::vector<long long> rows = group.integers("rows", {0}).values;
  const std::vector<long long> row_clusters = group.integers("row_clusters", {0}).values;
  const std::vector<long long> members = group.integers("members", {0}).values;
  clusters.rows.assign(rows.begin(), rows.end());
  clusters.row_clusters.assign(row_clusters.begin(), row_clusters.end());
  clusters.row_weights = group.reals("row_weights", {row_clusters.size()}).values;
  clusters.row_offsets = read_offsets(group, "row_offsets", row_clusters.size());
  clusters.members.assign(members.begin(), members.end());
  clusters.shares = group.reals("shares", {members.size()}).values;
  clusters.member_offsets = read_offsets(group, "member_offsets", members.size());
  const auto known = static_cast<long long>(clusters.clusters());
  const bool right = clusters.row_offsets.size() == rows.size() + 1 &&
                     std::all_of(row_clusters.begin(), row_clusters.end(),
                                 [known](long long cluster) { return cluster >= 0 && cluster < known; });
  if (!right) {
    throw FileError(group.file(), group.path() + "/row_clusters", "does not fit the clusters",
                    "numbers of the " + std::to_string(known) + " clusters for each of rows");
  }
  return clusters;
}

}  // namespace kiln
