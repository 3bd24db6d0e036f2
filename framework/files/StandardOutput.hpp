#pragma once

#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Writes a text to the program's standard output, once for all ranks. Throws FileError where it does not take it, as a
/// full disk. Collective.
void print(const Communicator& communicator, const std::string& text);

}  // namespace kiln
