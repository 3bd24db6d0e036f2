#pragma once

#include <functional>
#include <vector>

#include "rom/clustering/Points.hpp"
#include "rom/clustering/SharedSources.hpp"

namespace kiln {

/// A hierarchy of points: a node holds order[first, last), which its children share out.
struct ClusterTree {
  struct Node {
    std::size_t first, last;
    std::vector<std::size_t> children = {};  ///< numbers of nodes; none: a leaf

    std::size_t count() const { return last - first; }
  };
  std::vector<std::size_t> order;  ///< all points, those of a node next to each other
  std::vector<Node> nodes;
  std::vector<std::size_t> roots;

  /// Adds a root that holds `members` and, below it, nodes of `leaf` points at most or such as do not come apart.
  /// `split` sorts a node's points into the parts that its children take, at least two; an empty result leaves it
  /// whole. The children's numbers follow those of all nodes that are there.
  using Split =
      std::function<std::vector<std::vector<std::size_t>>(std::size_t node, const std::vector<std::size_t>& members)>;
  void grow(std::vector<std::size_t> members, std::size_t leaf, const Split& split);
};

/// How much of a cluster's state is a member's.
enum class Shares {
  equal,
  by_weight  ///< |weight|
};

/// One a member of a node.
std::vector<double> shares_of(const ClusterTree& tree, const ClusterTree::Node& node,
                              const std::vector<double>& weights, Shares shares);

/// Whether a node stands for its members in a row's sum.
using Accepts = std::function<bool(std::size_t row, std::size_t node)>;

/// How many clusters shared_clusters() gives a row.
std::size_t cluster_count(std::size_t row, const PairWeights& pairs, const SharedSources& sources,
                          const ClusterTree& tree, const Accepts& accepts);

/// The nodes that stand for their members in each row's sum. A node is taken where `accepts` says so and the row is not
/// in it; else its children are looked at, and of a leaf the particles one by one. So every source is in exactly one of
/// a row's clusters, and the row itself only where it is among its own sources. Rows share the clusters.
/// Points of `tree` are places in `sources`.
SourceClusters shared_clusters(const PairWeights& pairs, const SharedSources& sources, const ClusterTree& tree,
                               Shares shares, const Accepts& accepts);

}  // namespace kiln
