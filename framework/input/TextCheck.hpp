#pragma once

#include <string>

#include "framework/input/Location.hpp"
#include "framework/input/Mistakes.hpp"

namespace kiln {

/// Length of the UTF-8 character at byte `i`; 0: not one (RFC 3629: no overlong forms, no surrogates, at most
/// U+10FFFF).
std::size_t character_length(const std::string& text, std::size_t i);

/// Whether the text is one that a YAML parser may be trusted with: UTF-8 without control characters, no tab in the
/// indentation, no directive. Else adds the first mistake.
bool check_text(const std::string& text, const Location& origin, Mistakes& mistakes);

}  // namespace kiln
