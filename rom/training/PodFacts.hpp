#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rom/pod/Pod.hpp"

namespace kiln {

/// What a report says of a basis.
nlohmann::json facts_of(const Pod& pod);

}  // namespace kiln
