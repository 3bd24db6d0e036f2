#pragma once

#include "framework/registry/Specification.hpp"

namespace kiln {

/// The keys of a whole input file: what `kiln run`, `train` and `check` read.
Specification run_specification();

}  // namespace kiln
