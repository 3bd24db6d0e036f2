#pragma once

#include <string>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/files/Hdf5.hpp"

namespace kiln {

/// Writes a method's unknown x, exact to the bit: the local part of a vector over `map` (Method::coordinates()), either
/// distributed or the same on every rank. The dataset has one row an entry and one column, whichever it is. Collective.
void save_unknown(hdf5::Group& group, const std::string& name, const Map& map, ConstVectorView x);

/// Reads it back into x. Throws FileError for a dataset that is missing, has another length than x, or holds what is
/// not finite. Collective.
void restore_unknown(const hdf5::Group& group, const std::string& name, const Map& map, VectorView x);

}  // namespace kiln
