#include <algorithm>
#include <cmath>

#include "framework/base/Error.hpp"
#include "physics/vortex/PairLoops.hpp"
#include "physics/vortex/Quadtree.hpp"
#include "physics/vortex/VortexSum.hpp"

namespace kiln {
namespace {

/// Largest edge of a node's box.
double size_of(const QuadtreeNode& node) {
  return std::max(node.upper[0] - node.lower[0], node.upper[1] - node.lower[1]);
}

/// From the centre of a node's box to the nearest point of another's.
double distance(const QuadtreeNode& node, const QuadtreeNode& group) {
  double squares = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double centre = 0.5 * (node.lower[axis] + node.upper[axis]);
    const double beyond = std::max({group.lower[axis] - centre, centre - group.upper[axis], 0.0});
    squares += beyond * beyond;
  }
  return std::sqrt(squares);
}

/// Far vortices by the box: J. Barnes and P. Hut, Nature 324 (1986) 446, for groups of targets that share a list
/// (J. Barnes, J. Comput. Phys. 87 (1990) 161). A box of size s at a distance d from the whole group stands for its
/// vortices where s < θ d, as one vortex of each sign; of other leaves, and for θ = 0, every vortex counts. The tree is
/// rebuilt at each evaluation.
class BarnesHut final : public VortexSum {
 public:
  static Specification specification() {
    Specification specification;
    specification.real("opening", "θ: boxes of size s farther than s/θ are taken as one vortex of each sign")
        .at_least(0)
        .defaults_to(0.5);
    specification.integer("leaf", "most vortices of a box that is not divided").at_least(1).defaults_to(32);
    return specification;
  }

  BarnesHut(const Teuchos::ParameterList& list, const Context&)
      : opening_(list.get<double>("opening")), leaf_(list.get<int>("leaf")), tree_(leaf_) {}

  void velocities(const VortexKernel& kernel, const VortexArrays& vortices, const VortexTargets& targets, double factor,
                  double* velocities) override {
    if constexpr (!Kokkos::SpaceAccessibility<ExecutionSpace, Kokkos::HostSpace>::accessible) {
      throw NotOffered("BarnesHut", "velocities", "choose sum: direct away from the host");
    }
    tree_.build(vortices);
    row_at_.assign(static_cast<std::size_t>(vortices.count), -1);
    for (LocalIndex i = 0; i < targets.count; ++i) row_at_[targets.places[i]] = i;
    // The largest boxes that hold no more than a group's number of vortices.
    waiting_groups_.assign(1, 0);
    while (!waiting_groups_.empty()) {
      const QuadtreeNode& node = tree_.nodes()[waiting_groups_.back()];
      waiting_groups_.pop_back();
      if (node.children == 0 || node.count() <= leaves_a_group * leaf_) {
        sum_at(node, kernel, targets.points, factor, velocities);
      } else {
        for (int c = 0; c < node.children; ++c) waiting_groups_.push_back(node.child + c);
      }
    }
  }

 private:
  static constexpr int leaves_a_group = 2;

  void sum_at(const QuadtreeNode& group, const VortexKernel& kernel, const double* points, double factor,
              double* velocities) {
    group_rows_.clear();
    group_points_.clear();
    for (LocalIndex k = group.first; k < group.last; ++k) {
      const LocalIndex row = row_at_[tree_.place(k)];
      if (row < 0) continue;
      group_rows_.push_back(row);
      group_points_.push_back(points[2 * row]);
      group_points_.push_back(points[2 * row + 1]);
    }
    if (group_rows_.empty()) return;
    list_sources(group);
    group_velocities_.resize(group_points_.size());
    const auto count = static_cast<LocalIndex>(x_.size());
    kernel.velocities({x_.data(), y_.data(), circulation_.data(), count, count}, group_points_.data(),
                      static_cast<LocalIndex>(group_rows_.size()), factor, group_velocities_.data());
    for (std::size_t t = 0; t < group_rows_.size(); ++t) {
      velocities[2 * group_rows_[t]] = group_velocities_[2 * t];
      velocities[2 * group_rows_[t] + 1] = group_velocities_[2 * t + 1];
    }
  }

  /// What acts on a group, filled up to whole lanes.
  void list_sources(const QuadtreeNode& group) {
    x_.clear();
    y_.clear();
    circulation_.clear();
    waiting_.assign(1, 0);
    while (!waiting_.empty()) {
      const QuadtreeNode& node = tree_.nodes()[waiting_.back()];
      waiting_.pop_back();
      if (size_of(node) < opening_ * distance(node, group)) {
        for (const Monopole& monopole : node.monopole) {
          if (monopole.circulation != 0.0) add(monopole.x, monopole.y, monopole.circulation);
        }
      } else if (node.children > 0) {
        for (int c = 0; c < node.children; ++c) waiting_.push_back(node.child + c);
      } else {
        x_.insert(x_.end(), tree_.x().begin() + node.first, tree_.x().begin() + node.last);
        y_.insert(y_.end(), tree_.y().begin() + node.first, tree_.y().begin() + node.last);
        circulation_.insert(circulation_.end(), tree_.circulation().begin() + node.first,
                            tree_.circulation().begin() + node.last);
      }
    }
    // The group's own place, so that no distance becomes extreme.
    while (x_.size() % vortex_multiple != 0) add(group_points_[0], group_points_[1], 0.0);
  }

  void add(double x, double y, double circulation) {
    x_.push_back(x);
    y_.push_back(y);
    circulation_.push_back(circulation);
  }

  double opening_;
  int leaf_;
  Quadtree tree_;
  std::vector<LocalIndex> row_at_;  ///< row of each place, −1 for none
  std::vector<int> waiting_groups_, waiting_;
  std::vector<LocalIndex> group_rows_;
  std::vector<double> group_points_, group_velocities_;
  std::vector<double> x_, y_, circulation_;
};

KILN_REGISTER(VortexSum, BarnesHut, "barnes-hut", "far boxes of a quadtree as one vortex of each sign: O(N log N)");

}  // namespace
}  // namespace kiln
