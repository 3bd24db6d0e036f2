#pragma once

#include <string>
#include <string_view>

namespace kiln {

/// The SHA-256 of some bytes as 64 hexadecimal digits, as sha256sum prints it.
std::string sha256_of(std::string_view bytes);

}  // namespace kiln
