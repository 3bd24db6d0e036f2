#include "physics/vortex/Quadtree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiln {
namespace {

constexpr int levels = 31;

/// Spreads 31 bits to the even places of 62.
std::uint64_t spread_bits(std::uint64_t bits) {
  bits = (bits | bits << 16) & 0x0000ffff0000ffffULL;
  bits = (bits | bits << 8) & 0x00ff00ff00ff00ffULL;
  bits = (bits | bits << 4) & 0x0f0f0f0f0f0f0f0fULL;
  bits = (bits | bits << 2) & 0x3333333333333333ULL;
  return (bits | bits << 1) & 0x5555555555555555ULL;
}

/// Cell of a coordinate along one axis; what is not a number goes to cell 0.
std::uint64_t cell(double distance, double cells_a_metre) {
  constexpr double last = 2147483647.0;
  const double at = distance * cells_a_metre;
  return at > 0.0 ? static_cast<std::uint64_t>(std::min(at, last)) : 0;
}

/// Which quarter of its parent's square a key lies in, at a level from 1 on.
int quarter(std::uint64_t key, int level) { return static_cast<int>(key >> (2 * (levels - level)) & 3U); }

}  // namespace

void Quadtree::sort(const VortexArrays& vortices) {
  const auto count = static_cast<std::size_t>(vortices.count);
  const auto [left, right] = std::minmax_element(vortices.x, vortices.x + count);
  const auto [bottom, top] = std::minmax_element(vortices.y, vortices.y + count);
  const double width = std::max(*right - *left, *top - *bottom);
  const double cells_a_metre = width > 0.0 ? std::ldexp(1.0, levels) / width : 0.0;
  keys_.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    keys_[j] = {spread_bits(cell(vortices.x[j] - *left, cells_a_metre)) |
                    spread_bits(cell(vortices.y[j] - *bottom, cells_a_metre)) << 1,
                static_cast<LocalIndex>(j)};
  }
  std::sort(keys_.begin(), keys_.end());
  x_.resize(count);
  y_.resize(count);
  circulation_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const LocalIndex j = keys_[k].second;
    x_[k] = vortices.x[j];
    y_[k] = vortices.y[j];
    circulation_[k] = vortices.circulation[j];
  }
}

void Quadtree::split() {
  nodes_.clear();
  nodes_.push_back({0, static_cast<LocalIndex>(keys_.size()), 0, 0, 0, {}, {}, {}});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const LocalIndex first = nodes_[n].first, last = nodes_[n].last;
    if (last - first <= leaf_) continue;
    // Down to the level at which the vortices part.
    int level = nodes_[n].level + 1;
    while (level <= levels && quarter(keys_[first].first, level) == quarter(keys_[last - 1].first, level)) ++level;
    if (level > levels) continue;
    nodes_[n].child = static_cast<int>(nodes_.size());
    for (LocalIndex begin = first; begin < last;) {
      const int which = quarter(keys_[begin].first, level);
      const auto end = std::partition_point(keys_.begin() + begin, keys_.begin() + last,
                                            [&](const auto& key) { return quarter(key.first, level) == which; });
      const auto next = static_cast<LocalIndex>(end - keys_.begin());
      nodes_.push_back({begin, next, level, 0, 0, {}, {}, {}});
      ++nodes_[n].children;
      begin = next;
    }
  }
}

void Quadtree::summarise(QuadtreeNode& node) const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double lower[2] = {infinite, infinite}, upper[2] = {-infinite, -infinite};
  Monopole sums[2];
  const auto add = [&](int sign, double circulation, double x, double y) {
    sums[sign].circulation += circulation;
    sums[sign].x += circulation * x;
    sums[sign].y += circulation * y;
  };
  if (node.children == 0) {
    for (LocalIndex k = node.first; k < node.last; ++k) {
      lower[0] = std::min(lower[0], x_[k]);
      lower[1] = std::min(lower[1], y_[k]);
      upper[0] = std::max(upper[0], x_[k]);
      upper[1] = std::max(upper[1], y_[k]);
      add(circulation_[k] < 0.0 ? 1 : 0, circulation_[k], x_[k], y_[k]);
    }
  }
  for (int c = node.child; c < node.child + node.children; ++c) {
    const QuadtreeNode& child = nodes_[c];
    for (int axis = 0; axis < 2; ++axis) {
      lower[axis] = std::min(lower[axis], child.lower[axis]);
      upper[axis] = std::max(upper[axis], child.upper[axis]);
    }
    for (int sign = 0; sign < 2; ++sign) {
      const Monopole& part = child.monopole[sign];
      add(sign, part.circulation, part.x, part.y);
    }
  }
  std::copy(lower, lower + 2, node.lower);
  std::copy(upper, upper + 2, node.upper);
  for (int sign = 0; sign < 2; ++sign) {
    const double circulation = sums[sign].circulation;
    const double share = circulation != 0.0 ? 1.0 / circulation : 0.0;
    node.monopole[sign] = {share * sums[sign].x, share * sums[sign].y, circulation};
  }
}

void Quadtree::build(const VortexArrays& vortices) {
  nodes_.clear();
  if (vortices.count == 0) return;
  sort(vortices);
  split();
  // Children come behind their parents.
  for (std::size_t n = nodes_.size(); n-- > 0;) summarise(nodes_[n]);
}

}  // namespace kiln
