#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "framework/registry/Specification.hpp"

namespace kiln {

/// A JSON Schema (draft-07) of a whole input file, for editors: types, ranges, choices, units, the keys of each type of
/// component, what is required, help. A file that includes others may leave out what these give. What only Kiln can
/// tell is left to it: compound units' dimensions, conditions over several keys, whether files exist.
nlohmann::ordered_json schema_of(const Specification& specification, const std::string& title);

}  // namespace kiln
