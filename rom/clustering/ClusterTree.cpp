#include "rom/clustering/ClusterTree.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace kiln {
namespace {

/// A stretch of the tree's order: a node, or one particle.
using Stretch = std::pair<std::size_t, std::size_t>;

class RowLists {
 public:
  RowLists(const PairWeights& pairs, const SharedSources& sources, const ClusterTree& tree, const Accepts& accepts)
      : pairs_(pairs), sources_(sources), tree_(tree), accepts_(accepts), places_(tree.order.size()) {
    for (std::size_t k = 0; k < places_.size(); ++k) places_[tree.order[k]] = k;
  }

  std::vector<Stretch> of(std::size_t row) const {
    const auto found = std::lower_bound(sources_.ids.begin(), sources_.ids.end(), pairs_.rows[row]);
    const bool is_source = found != sources_.ids.end() && *found == pairs_.rows[row];
    // Beyond all particles where the row is none of the sources.
    const std::size_t itself = is_source ? places_[found - sources_.ids.begin()] : places_.size();
    std::vector<Stretch> stretches;
    std::vector<std::size_t> open(tree_.roots.rbegin(), tree_.roots.rend());
    while (!open.empty()) {
      const std::size_t number = open.back();
      open.pop_back();
      const ClusterTree::Node& node = tree_.nodes[number];
      const bool within = node.first <= itself && itself < node.last;
      if (!within && (node.count() == 1 || accepts_(row, number))) {
        stretches.push_back({node.first, node.last});
      } else if (node.children.empty()) {
        for (std::size_t k = node.first; k < node.last; ++k) {
          if (k != itself || sources_.own[row]) stretches.push_back({k, k + 1});
        }
      } else {
        open.insert(open.end(), node.children.rbegin(), node.children.rend());
      }
    }
    return stretches;
  }

 private:
  const PairWeights& pairs_;
  const SharedSources& sources_;
  const ClusterTree& tree_;
  const Accepts& accepts_;
  std::vector<std::size_t> places_;  ///< of each point in tree.order
};

}  // namespace

void ClusterTree::grow(std::vector<std::size_t> members, std::size_t leaf, const Split& split) {
  struct Waiting {
    std::size_t node;
    std::vector<std::size_t> members;
  };
  const std::size_t first = order.size();
  order.insert(order.end(), members.begin(), members.end());
  roots.push_back(nodes.size());
  nodes.push_back({first, order.size()});
  std::vector<Waiting> waiting;
  waiting.push_back({roots.back(), std::move(members)});
  while (!waiting.empty()) {
    const Waiting one = std::move(waiting.back());
    waiting.pop_back();
    if (one.members.size() <= leaf) continue;
    std::size_t at = nodes[one.node].first;
    for (std::vector<std::size_t>& part : split(one.node, one.members)) {
      std::copy(part.begin(), part.end(), order.begin() + static_cast<std::ptrdiff_t>(at));
      nodes[one.node].children.push_back(nodes.size());
      nodes.push_back({at, at + part.size()});
      at += part.size();
      waiting.push_back({nodes.size() - 1, std::move(part)});
    }
  }
}

std::vector<double> shares_of(const ClusterTree& tree, const ClusterTree::Node& node,
                              const std::vector<double>& weights, Shares shares) {
  std::vector<double> result(node.count(), 1.0);
  if (shares == Shares::by_weight) {
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = std::abs(weights[tree.order[node.first + k]]);
  }
  double sum = std::accumulate(result.begin(), result.end(), 0.0);
  if (sum == 0.0) {
    std::fill(result.begin(), result.end(), 1.0);
    sum = static_cast<double>(result.size());
  }
  for (double& share : result) share /= sum;
  return result;
}

std::size_t cluster_count(std::size_t row, const PairWeights& pairs, const SharedSources& sources,
                          const ClusterTree& tree, const Accepts& accepts) {
  return RowLists(pairs, sources, tree, accepts).of(row).size();
}

SourceClusters shared_clusters(const PairWeights& pairs, const SharedSources& sources, const ClusterTree& tree,
                               Shares shares, const Accepts& accepts) {
  const RowLists lists(pairs, sources, tree, accepts);
  std::vector<std::vector<Stretch>> rows;
  std::map<Stretch, std::size_t> numbers;
  for (std::size_t row = 0; row < pairs.rows.size(); ++row) {
    rows.push_back(lists.of(row));
    for (const Stretch& stretch : rows.back()) numbers.emplace(stretch, 0);
  }
  SourceClusters result;
  result.rows = pairs.rows;
  result.row_offsets = result.member_offsets = {0};
  std::vector<double> cluster_weights;
  for (auto& [stretch, number] : numbers) {
    number = result.clusters();
    const std::vector<double> of_members = shares_of(tree, {stretch.first, stretch.second}, sources.weights, shares);
    double weight = 0.0;
    for (std::size_t k = 0; k < of_members.size(); ++k) {
      const std::size_t source = tree.order[stretch.first + k];
      result.members.push_back(sources.ids[source]);
      result.shares.push_back(of_members[k]);
      weight += sources.weights[source];
    }
    result.member_offsets.push_back(result.members.size());
    cluster_weights.push_back(weight);
  }
  for (const std::vector<Stretch>& row : rows) {
    std::vector<std::size_t> own;
    for (const Stretch& stretch : row) own.push_back(numbers.at(stretch));
    std::sort(own.begin(), own.end());
    for (const std::size_t cluster : own) {
      result.row_clusters.push_back(cluster);
      result.row_weights.push_back(cluster_weights[cluster]);
    }
    result.row_offsets.push_back(result.row_clusters.size());
  }
  return result;
}

}  // namespace kiln
