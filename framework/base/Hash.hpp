#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kiln {

/// The 128-bit XXH3 hash as 32 hexadecimal digits: tells whether two inputs are the same, no proof against forgery.
std::string hash_of(std::string_view bytes);
/// Of a file's bytes, read in pieces. Throws FileError. Not collective.
std::string hash_of_file(const std::filesystem::path& path);

}  // namespace kiln
