#pragma once

#include <Teuchos_ParameterList.hpp>

#include "framework/model/ParameterPoints.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// Keys of the block `queries`: points of a model's live parameters, all of which one run answers.
Specification query_specification();

/// The points that a checked block `queries` lists, or the table it names: in SI units. With `grid` all combinations,
/// the last parameter fastest. Throws InputError with all mistakes of `points`, FileError for a table whose columns are
/// no parameters or no numbers.
ParameterPoints query_points(const Teuchos::ParameterList& queries, const Parameters& parameters);

}  // namespace kiln
