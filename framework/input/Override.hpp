#pragma once

#include <string>

#include "framework/input/Yaml.hpp"

namespace kiln {

/// "--set path.to.key=value", which is where an override's mistakes are said to be; of a very long one the beginning.
std::string override_place(const std::string& override_text);

/// Applies "path.to.key=value" to the tree: the value is YAML, items of lists go by their number from 0 (the number
/// after the last one adds an item), blocks on the way are created. Its place is override_place().
void apply_override(const std::string& override_text, YamlNode& root, Mistakes& mistakes);

}  // namespace kiln
