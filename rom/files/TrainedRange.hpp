#pragma once

#include <string>
#include <vector>

#include "framework/files/Hdf5.hpp"
#include "framework/model/ParameterPoints.hpp"

namespace kiln {

/// The values of one live parameter at the points that a reduction was learnt from or tried on, in its SI unit.
struct TrainedRange {
  std::string name;
  double least, most;
};

/// Group points: one dataset a parameter, its value at each point.
void write_points(hdf5::Group& root, const ParameterPoints& points);
/// Throws FileError for a parameter without values and for values that are not finite.
std::vector<TrainedRange> read_trained_ranges(const hdf5::Group& root);

/// A sentence that names the parameters whose value lies outside the range of the training; empty: none does.
std::string outside_of(const std::vector<TrainedRange>& ranges, const Parameters& parameters);

}  // namespace kiln
