#pragma once

#include <Teuchos_ParameterList.hpp>

#include "framework/model/ParameterPoints.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// Keys of a block that lists points of a model's live parameters: points, file, grid.
Specification points_specification();
/// The same and `together`: keys of the block `queries`, whose points one run answers.
Specification query_specification();

/// The points that a checked block lists, or the table it names: in SI units. With `grid` all combinations, the last
/// parameter fastest. Throws InputError with all mistakes of `points`, FileError for a table whose columns are no
/// parameters or no numbers.
ParameterPoints points_of(const Teuchos::ParameterList& block, const Parameters& parameters);

}  // namespace kiln
