#pragma once

#include <array>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/files/Hdf5.hpp"

namespace kiln {

/// Positions that a training was asked about, and how far the few particles of a reduction tell which one is nearest.
struct Questions {
  std::vector<std::array<double, 3>> positions;  ///< m
  std::vector<GlobalIndex> nearest;              ///< the particle nearest to each
  double spacing = 0.0;  ///< m: no particle that is held has another one, held or not, nearer than this

  /// The particles of `nearest`, ascending and once each.
  std::vector<GlobalIndex> particles() const;
  /// Whether the particle nearest to a point among those held, at `distance` (m), is the nearest of all: the training
  /// was asked about the point, or half the spacing leaves no room for another one.
  bool tells(const std::array<double, 3>& point, double distance) const;

  /// Datasets asked (n × 3) and nearest, attribute spacing.
  void write(hdf5::Group& group) const;
  /// Throws FileError for what is missing, not finite or of another shape.
  static Questions read(const hdf5::Group& group);
};

}  // namespace kiln
