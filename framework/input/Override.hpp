#pragma once

#include <string>

#include "framework/input/Yaml.hpp"

namespace kiln {

/// Applies "path.to.key=value" to the tree: the value is YAML, items of lists go by their number from 0 (the number
/// after the last one adds an item), blocks on the way are created. Its place is "--set path.to.key=value".
void apply_override(const std::string& override_text, YamlNode& root, Mistakes& mistakes);

}  // namespace kiln
