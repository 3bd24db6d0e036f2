#pragma once

#include <string>

#include "framework/input/Location.hpp"
#include "framework/input/Mistakes.hpp"

namespace kiln {

/// Whether the text is one that a YAML parser may be trusted with: UTF-8 without control characters, no tab in the
/// indentation, no directive. Else adds the first mistake.
bool check_text(const std::string& text, const Location& origin, Mistakes& mistakes);

}  // namespace kiln
