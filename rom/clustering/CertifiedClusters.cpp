#include "rom/clustering/CertifiedClusters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "framework/base/Error.hpp"
#include "rom/clustering/ClusterTree.hpp"

namespace kiln {
namespace {

/// The two halves of a node, cut half way along the coordinate in which its points lie farthest apart. Empty where they
/// coincide.
std::vector<std::vector<std::size_t>> halves(const Points& points, const std::vector<std::size_t>& members) {
  std::size_t widest = 0;
  double extent = 0.0, lower = 0.0;
  for (std::size_t k = 0; k < points.dimension; ++k) {
    double low = points[members.front()][k], high = low;
    for (const std::size_t m : members) {
      low = std::min(low, points[m][k]);
      high = std::max(high, points[m][k]);
    }
    if (high - low > extent * (1.0 + clustering_tie)) {
      widest = k;
      extent = high - low;
      lower = low;
    }
  }
  std::vector<std::vector<std::size_t>> result;
  if (extent == 0.0) return result;
  result.resize(2);
  const double middle = lower + (0.5 - clustering_tie) * extent;
  for (const std::size_t m : members) result[points[m][widest] < middle ? 0 : 1].push_back(m);
  return result;
}

/// Where the members of nodes are and how far apart, moment by moment; found when it is first asked for.
class NodeMotion {
 public:
  NodeMotion(const Points& points, const ClusterTree& tree, const std::vector<double>& weights, std::size_t components)
      : points_(points), tree_(tree), weights_(weights), components_(components), nodes_(tree.nodes.size()) {}

  /// Whether size/√(distance² + smooth²) < opening at all moments for a target with this trajectory.
  bool accepted(const double* target, std::size_t node, double opening, double smooth) {
    const Motion& motion = of(node);
    for (std::size_t moment = 0; moment < motion.sides.size(); ++moment) {
      const std::size_t at = moment * components_;
      const double squared = squared_distance(target + at, &motion.means[at], components_) + smooth * smooth;
      if (!(motion.sides[moment] < opening * std::sqrt(squared))) return false;
    }
    return true;
  }

 private:
  struct Motion {
    std::vector<double> means;  ///< moments × components
    std::vector<double> sides;  ///< widest side of the members' box at each moment
  };

  const Motion& of(std::size_t number) {
    Motion& motion = nodes_[number];
    if (!motion.means.empty()) return motion;
    const ClusterTree::Node& node = tree_.nodes[number];
    const std::vector<double> shares = shares_of(tree_, node, weights_, Shares::by_weight);
    motion.means.assign(points_.dimension, 0.0);
    motion.sides.assign(points_.dimension / components_, 0.0);
    for (std::size_t d = 0; d < points_.dimension; ++d) {
      double low = points_[tree_.order[node.first]][d], high = low;
      for (std::size_t k = 0; k < shares.size(); ++k) {
        const double value = points_[tree_.order[node.first + k]][d];
        motion.means[d] += shares[k] * value;
        low = std::min(low, value);
        high = std::max(high, value);
      }
      double& side = motion.sides[d / components_];
      side = std::max(side, high - low);
    }
    return motion;
  }

  const Points& points_;
  const ClusterTree& tree_;
  const std::vector<double>& weights_;
  std::size_t components_;
  std::vector<Motion> nodes_;
};

/// Openings that a limit on the number of clusters chooses from.
constexpr int openings = 128;
double opening_of(int k) { return 8.0 * std::exp2(-k / 8.0); }

/// The smallest opening that leaves each row at most so many clusters. Throws InputError where none does.
std::vector<double> smallest_openings(std::size_t most, const std::string& path, const PairWeights& pairs,
                                      const std::function<std::size_t(std::size_t row, double opening)>& count) {
  std::vector<double> result;
  for (std::size_t row = 0; row < pairs.rows.size(); ++row) {
    int fits = -1, exceeds = openings;
    while (exceeds - fits > 1) {
      const int middle = (fits + exceeds) / 2;
      (count(row, opening_of(middle)) <= most ? fits : exceeds) = middle;
    }
    if (fits < 0) {
      throw InputError(path + ".clusters",
                       fmt::format("{} are too few: row {} has {} even with the widest opening", most, pairs.rows[row],
                                   count(row, opening_of(0))),
                       "at least as many");
    }
    result.push_back(opening_of(fits));
  }
  return result;
}

}  // namespace

Specification CertifiedClusters::specification() {
  Specification s;
  s.real("opening",
         "a cluster is taken where its size is less than this times its distance at all moments; 0.5 if "
         "neither this nor `clusters` is given")
      .above(0)
      .optional();
  s.integer("clusters", "most clusters of a row; each row's opening follows from it").at_least(1).optional();
  s.real("smooth",
         "length over which a source may move without its pair term changing much, as within a core radius; distances "
         "count as at least that, so that the number of clusters stops growing with the number of particles")
      .at_least(0)
      .defaults_to(0.0);
  s.integer("leaf", "most particles of a node that is not cut in two").at_least(1).defaults_to(1);
  WeightFit::specify(s, "sums");
  s.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    if (!list.isParameter("opening") || !list.isParameter("clusters")) return;
    problems.push_back({"", "says both opening and clusters", "one of them: the other follows from it", ""});
  });
  return s;
}

CertifiedClusters::CertifiedClusters(const Teuchos::ParameterList& list, const NoContext&)
    : path_(list.name()),
      opening_(list.isParameter("opening") ? list.get<double>("opening") : 0.5),
      most_(list.isParameter("clusters") ? list.get<int>("clusters") : 0),
      smooth_(list.get<double>("smooth")),
      leaf_(list.get<int>("leaf")),
      weight_fit_(WeightFit::of(list)) {}

SourceClusters CertifiedClusters::clusters(const PairWeights& pairs, const SourceMotion& motion) const {
  const SharedSources sources(pairs, path_);
  std::vector<std::size_t> places, targets;
  for (const GlobalIndex id : sources.ids) places.push_back(motion.place(id));
  for (const GlobalIndex id : pairs.rows) targets.push_back(motion.place(id));
  const Points points = trajectories(motion, places), target_points = trajectories(motion, targets);

  std::vector<std::vector<std::size_t>> signs(2);
  for (std::size_t k = 0; k < places.size(); ++k) signs[sources.weights[k] < 0.0 ? 1 : 0].push_back(k);
  ClusterTree tree;
  for (std::vector<std::size_t>& sign : signs) {
    if (sign.empty()) continue;
    tree.grow(std::move(sign), leaf_,
              [&points](std::size_t, const std::vector<std::size_t>& members) { return halves(points, members); });
  }
  NodeMotion nodes(points, tree, sources.weights, motion.components);
  std::vector<double> opening(pairs.rows.size(), opening_);
  const auto accepts = [&](std::size_t row, std::size_t node) {
    return nodes.accepted(target_points[row], node, opening[row], smooth_);
  };
  if (most_ > 0) {
    opening = smallest_openings(most_, path_, pairs, [&](std::size_t row, double tried) {
      opening[row] = tried;
      return cluster_count(row, pairs, sources, tree, accepts);
    });
  }
  return shared_clusters(pairs, sources, tree, Shares::by_weight, accepts);
}

KILN_REGISTER(SourceClustering, CertifiedClusters, "robust",
              "clusters far enough from a row at all moments of the training, weighted and split by sign");

}  // namespace kiln
