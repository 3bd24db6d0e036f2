#pragma once

#include <Teuchos_ParameterList.hpp>

#include "framework/model/Model.hpp"
#include "rom/files/Questions.hpp"

namespace kiln {

/// Positions whose state online runs must be able to tell, each with the particle nearest to it (the lowest id where
/// several are as near): the probes of `output.probes.points`, and `queries` in the block `reduction`. The same on
/// every rank. Collective.
Questions questions_of(const Teuchos::ParameterList& input, const Model& model);

}  // namespace kiln
