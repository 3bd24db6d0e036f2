#pragma once

#include <string>
#include <vector>

#include "framework/registry/Specification.hpp"

namespace kiln {

/// What an entry may hold, for error messages: "a length in m above 0", "one of: lu, qr", "a list of 3 integers".
std::string expectation(const Entry& entry);
/// What one number of the entry may be: "above 0 and at most 1"; empty without bounds. Bounds are in the entry's unit.
std::string range_text(const Entry& entry);
/// A bound with the entry's unit: "0.01 m", "0".
std::string bound_text(double bound, const Entry& entry);
/// What kind of value the entry holds, for tables: "number", "3 integers", "block", "kernel".
std::string type_text(const Entry& entry);
/// The default as it stands in YAML; empty without one.
std::string default_text(const Entry& entry);
/// What stands in a table of keys: the default, or "required", or "optional".
std::string default_column(const Entry& entry);
/// Likewise: choices, registered names or the range.
std::vector<std::string> values_column(const Entry& entry);
/// A text as YAML, in quotes where it needs them.
std::string yaml_text(const std::string& text);
/// The key under which a registered component stands where Specification::blocks allows it.
std::string block_key(const std::string& name);

}  // namespace kiln
