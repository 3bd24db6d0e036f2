#pragma once

#include <vector>

#include "rom/clustering/SourceClustering.hpp"

namespace kiln {

/// Values within this share of each other count as equal when points are compared: round-off, by which numbers of ranks
/// differ, is far below it, and so is what separates particles that a symmetric problem moves alike.
constexpr double clustering_tie = 1e-9;

/// Points of some space, one after the other.
struct Points {
  std::size_t dimension;
  std::vector<double> values;

  const double* operator[](std::size_t point) const { return values.data() + point * dimension; }
};

double squared_distance(const double* a, const double* b, std::size_t dimension);

/// Trajectories as points: a particle's states at all moments. Distances are root-sum-square separations over the
/// window, those of rows of [u_begin, ΦΣ] where the window's snapshots are the moments and V is orthonormal.
/// `particles`: places in motion.ids.
Points trajectories(const SourceMotion& motion, const std::vector<std::size_t>& particles);

}  // namespace kiln
