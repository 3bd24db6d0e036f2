#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/ParameterPoints.hpp"

namespace kiln {

/// States that a training met in one time window, at the points it learns from.
struct LearntStates {
  ParameterPoints points;               ///< all live parameters at each point
  std::vector<VectorView> coordinates;  ///< of all windows, one vector a state
  std::vector<std::size_t> at;          ///< the point of each state
};

}  // namespace kiln
