#pragma once

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <vector>

#include "framework/model/Model.hpp"

namespace kiln {

/// Positions whose state online runs must be able to tell: the probes of `output.probes.points` and the extra ones of
/// `queries` in the block `reduction`; metres.
std::vector<std::array<double, 3>> queried_positions(const Teuchos::ParameterList& input);

/// Ids of the particles nearest to the positions, ascending and once each; the lowest id where several are as near. The
/// same on every rank. Collective.
std::vector<GlobalIndex> nearest_particles(const Model& model, const std::vector<std::array<double, 3>>& positions);

}  // namespace kiln
