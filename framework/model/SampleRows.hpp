#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The ids of a sample's rows in ascending order. Throws InputError, on every rank, for an id that is there twice or
/// that is no row of the model. Collective.
std::vector<GlobalIndex> checked_rows(std::vector<GlobalIndex> ids, const Map& model_rows);

}  // namespace kiln
