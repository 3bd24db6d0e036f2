#pragma once

#include <vector>

#include "rom/clustering/Points.hpp"

namespace kiln {

/// Cuts weighted points into at most `parts` parts whose scatter
///
///     Σ_parts Σ_m weight_m ‖x_m − mean of the part‖²
///
/// is small (weighted k-means). The part of largest scatter is cut in two, across its principal direction where that
/// lowers the scatter most, until there are enough; then points move to the nearest mean until none gains by it
/// (Lloyd). No random numbers; ties go to the lower point, and points that coincide stay together, so that there may be
/// fewer parts.
///
/// `groups`: points that must not come into one part with others; parts belong to one group each. Weights above 0, one
/// a point. The result's parts ascend, and are in the order of their first points.
std::vector<std::vector<std::size_t>> partition(const Points& points, const std::vector<double>& weights,
                                                const std::vector<std::vector<std::size_t>>& groups, std::size_t parts);

}  // namespace kiln
