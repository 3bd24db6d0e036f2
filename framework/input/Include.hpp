#pragma once

#include <string>

#include "framework/input/InputFiles.hpp"
#include "framework/input/Yaml.hpp"

namespace kiln {

/// Reads `file` and the files its top-level key `include` names (one or a list; relative to the file that names them,
/// and they may include others). A file wins over those it includes, a later included file over an earlier one. Blocks
/// merge key by key, except that a block of another `type` replaces the one underneath. Returns false if any of the
/// files could not be read or understood.
bool read_with_includes(const std::string& file, InputFiles& files, YamlNode& root, Mistakes& mistakes);

}  // namespace kiln
