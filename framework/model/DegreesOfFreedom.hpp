#pragma once

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Map of the entries of an array over particles × components: component c of particle p has the id
/// p · components + c, and entries lie in the order of `particles`. `particles` itself for one component. Collective.
Teuchos::RCP<const Map> degree_of_freedom_map(const Teuchos::RCP<const Map>& particles, int components);

}  // namespace kiln
