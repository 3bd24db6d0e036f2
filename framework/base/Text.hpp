#pragma once

#include <cstddef>
#include <string>

namespace kiln {

/// Length of the UTF-8 character at byte `i`; 0: not one (RFC 3629: no overlong forms, no surrogates, at most
/// U+10FFFF).
std::size_t character_length(const std::string& text, std::size_t i);

/// `text` for a message: control characters and bytes that are no UTF-8 escaped.
std::string printable(const std::string& text);
/// The same, cut after 60 characters.
std::string shown(const std::string& text, std::size_t longest = 60);
/// The same in single quotes.
std::string in_quotes(const std::string& text);

}  // namespace kiln
