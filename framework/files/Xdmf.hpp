#pragma once

#include <string>
#include <vector>

#include "framework/base/Field.hpp"

namespace kiln {

/// One written moment of a run file.
struct XdmfFrame {
  std::size_t frame;  ///< row in the run file's datasets
  double time;        ///< in s
};

/// The XDMF 3 text that shows a run file to ParaView and VisIt: a temporal collection of particles (Polyvertex) with
/// their fields. `file` is the run file's name relative to the XDMF file. Fields are read from the run file's
/// one-dimensional `/frame/FIELD/K`: a HyperSlab of the two-dimensional `/FIELD` would be shorter, but the XDMF 3
/// library, and ParaView with it, transposes it.
std::string xdmf(const std::string& file, std::size_t particles, const std::vector<Field>& fields,
                 const std::vector<XdmfFrame>& frames);

}  // namespace kiln
