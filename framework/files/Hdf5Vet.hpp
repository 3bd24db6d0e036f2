#pragma once

#include <optional>
#include <string>

#include "framework/files/Together.hpp"

namespace kiln::hdf5 {

/// What is wrong with an HDF5 file that comes from anywhere. HDF5 1.10 may crash, or read for ever, on a damaged file;
/// so a child of this process opens it first, walks through all groups, datasets and attributes, and reads what is
/// compressed. Also refuses links and datasets that lead to other files. Serial; rank 0 alone.
std::optional<Fault> vet(const std::string& path);

}  // namespace kiln::hdf5
