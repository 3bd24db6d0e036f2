#pragma once

#include <string>
#include <string_view>

namespace kiln {

/// What keeps the bytes of a file from being a whole shared library (ELF, 64 bits); empty: nothing. The system's loader
/// trusts the tables of a file that it maps, and one cut short ends the program.
std::string shared_library_problem(std::string_view bytes);

}  // namespace kiln
