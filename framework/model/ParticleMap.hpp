#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Map of particles over ranks: `ids` are this rank's, in the order of its entries. Collective.
Teuchos::RCP<const Map> map_of(const std::vector<GlobalIndex>& ids,
                               const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
