#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace kiln {

/// A run report as an aligned table, one block a section: what `kiln report` prints. A key's ending tells its unit:
/// `_s`, `_m`, `_kelvin`, `_percent`, `_bytes`, `ns_` in front; texts of several lines, such as the timer's table,
/// stand as they are.
std::string readable(const nlohmann::json& report);

}  // namespace kiln
