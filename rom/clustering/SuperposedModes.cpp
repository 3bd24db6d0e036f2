#include "rom/clustering/SuperposedModes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "rom/clustering/ClusterTree.hpp"

namespace kiln {
namespace {

Points superposed(const SourceMotion& motion) {
  Points points{static_cast<std::size_t>(motion.components), {}};
  for (std::size_t i = 0; i < motion.beginning.extent(0); ++i) {
    double place = motion.beginning(i);
    for (std::size_t k = 0; k < motion.modes.extent(1); ++k) {
      place += motion.singular_values[k] / motion.singular_values.front() * motion.modes(i, k);
    }
    points.values.push_back(place);
  }
  return points;
}

/// A box with sides of one length.
struct Cell {
  std::vector<double> lower;
  double side;
};

/// The tree of halved cells.
class HalvedCells {
 public:
  HalvedCells(const Points& points, std::vector<std::size_t> members, std::size_t leaf) : points_(points) {
    Cell root{std::vector<double>(points.dimension, std::numeric_limits<double>::infinity()), 0.0};
    for (std::size_t d = 0; d < points.dimension; ++d) {
      double upper = -std::numeric_limits<double>::infinity();
      for (const std::size_t m : members) {
        root.lower[d] = std::min(root.lower[d], points[m][d]);
        upper = std::max(upper, points[m][d]);
      }
      root.side = std::max(root.side, upper - root.lower[d]);
    }
    smallest_ = clustering_tie * root.side;
    cells_.push_back(root);
    tree_.grow(std::move(members), leaf,
               [this](std::size_t node, const std::vector<std::size_t>& of_node) { return halve(node, of_node); });
  }

  const ClusterTree& tree() const { return tree_; }
  double side(std::size_t node) const { return cells_[node].side; }

 private:
  std::vector<std::vector<std::size_t>> halve(std::size_t node, const std::vector<std::size_t>& members) {
    std::map<std::vector<char>, std::vector<std::size_t>> corners;
    while (cells_[node].side > smallest_) {
      corners.clear();
      for (const std::size_t m : members) corners[corner(m, cells_[node])].push_back(m);
      if (corners.size() > 1) break;
      // All are in one corner, which holds them more closely.
      cells_[node] = part(cells_[node], corners.begin()->first);
    }
    std::vector<std::vector<std::size_t>> parts;
    if (corners.size() < 2) return parts;
    for (auto& [at, of_corner] : corners) {
      cells_.push_back(part(cells_[node], at));
      parts.push_back(std::move(of_corner));
    }
    return parts;
  }

  std::vector<char> corner(std::size_t point, const Cell& cell) const {
    std::vector<char> upper(points_.dimension);
    for (std::size_t d = 0; d < points_.dimension; ++d) {
      upper[d] = points_[point][d] - cell.lower[d] >= (0.5 - clustering_tie) * cell.side ? 1 : 0;
    }
    return upper;
  }

  static Cell part(const Cell& cell, const std::vector<char>& upper) {
    Cell result{cell.lower, 0.5 * cell.side};
    for (std::size_t d = 0; d < upper.size(); ++d) {
      if (upper[d] != 0) result.lower[d] += result.side;
    }
    return result;
  }

  const Points& points_;
  double smallest_ = 0.0;
  ClusterTree tree_;
  std::vector<Cell> cells_;  ///< one a node
};

}  // namespace

Specification SuperposedModes::specification() {
  Specification s;
  s.real("opening", "a cell is taken where its side is less than this times its distance").above(0).defaults_to(0.5);
  s.integer("leaf", "most particles of a cell that is not halved").at_least(1).defaults_to(8);
  return s;
}

SuperposedModes::SuperposedModes(const Teuchos::ParameterList& list, const NoContext&)
    : path_(list.name()), opening_(list.get<double>("opening")), leaf_(list.get<int>("leaf")) {}

SourceClusters SuperposedModes::clusters(const PairWeights& pairs, const SourceMotion& motion) const {
  const SharedSources sources(pairs, path_);
  const Points all = superposed(motion);
  Points points{all.dimension, {}};
  std::vector<std::size_t> members;
  for (const GlobalIndex id : sources.ids) {
    const double* point = all[motion.place(id)];
    points.values.insert(points.values.end(), point, point + all.dimension);
    members.push_back(members.size());
  }
  const HalvedCells cells(points, std::move(members), leaf_);
  const ClusterTree& tree = cells.tree();
  std::vector<double> centres;
  for (const ClusterTree::Node& node : tree.nodes) {
    for (std::size_t d = 0; d < points.dimension; ++d) {
      double sum = 0.0;
      for (std::size_t k = node.first; k < node.last; ++k) sum += points[tree.order[k]][d];
      centres.push_back(sum / static_cast<double>(node.count()));
    }
  }
  return shared_clusters(pairs, sources, tree, Shares::equal, [&](std::size_t row, std::size_t node) {
    const double* target = all[motion.place(pairs.rows[row])];
    const double distance = std::sqrt(squared_distance(target, &centres[node * points.dimension], points.dimension));
    return cells.side(node) < opening_ * distance;
  });
}

KILN_REGISTER(SourceClustering, SuperposedModes, "paper",
              "Barnes-Hut cells of the superposed modes (Appendix A of NRL/6390/MR--2022/1)");

}  // namespace kiln
