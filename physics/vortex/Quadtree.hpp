#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "physics/vortex/VortexKernel.hpp"

namespace kiln {

/// Several vortices of one sign as one, at their centre of circulation; it has no dipole moment about it.
struct Monopole {
  double x = 0.0;            ///< m
  double y = 0.0;            ///< m
  double circulation = 0.0;  ///< m²/s; 0: there is none of this sign
};

/// A square of the tree, shrunk to the vortices in it.
struct QuadtreeNode {
  LocalIndex first;  ///< its vortices are first … last − 1 in the tree's order
  LocalIndex last;
  int level;             ///< of its square; the root's is 0
  int child = 0;         ///< the first of its children, which follow each other
  int children = 0;      ///< 0 for a leaf
  double lower[2];       ///< in m
  double upper[2];       ///< in m
  Monopole monopole[2];  ///< of the vortices turning counter-clockwise, and of the others

  LocalIndex count() const { return last - first; }
};

/// Vortices sorted into squares, each cut in four until no more than a leaf's number are left (H. Samet 1984; J. Barnes
/// and P. Hut, Nature 324 (1986) 446). The tree depends on places and circulations alone, not on ranks.
class Quadtree {
 public:
  /// leaf: most vortices of a square that is not cut, unless they lie closer than 2^−31 of the tree's width.
  explicit Quadtree(int leaf) : leaf_(leaf) {}
  /// Rebuilds the tree. Values that are not finite end in some leaf.
  void build(const VortexArrays& vortices);

  /// The root first, a parent before its children.
  const std::vector<QuadtreeNode>& nodes() const { return nodes_; }
  /// In the tree's order: the place of each vortex among those it was built from, and the vortices themselves.
  LocalIndex place(LocalIndex k) const { return keys_[k].second; }
  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }
  const std::vector<double>& circulation() const { return circulation_; }

 private:
  void sort(const VortexArrays& vortices);
  void split();
  void summarise(QuadtreeNode& node) const;

  int leaf_;
  std::vector<std::pair<std::uint64_t, LocalIndex>> keys_;  ///< Morton key and place, ascending
  std::vector<double> x_, y_, circulation_;
  std::vector<QuadtreeNode> nodes_;
};

}  // namespace kiln
