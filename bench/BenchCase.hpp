#pragma once

#include <array>
#include <memory>
#include <string>

#include "physics/sph/HeatModel.hpp"

namespace kiln::bench {

/// A part like the report's Experiment 1 on a lattice with spacings of about 40 µm.
struct BenchCase {
  std::array<int, 3> count = {100, 50, 14};

  std::unique_ptr<HeatModel> lattice(const Teuchos::RCP<const Communicator>& communicator) const;
  /// The same particles, each moved by up to a fifth of a spacing along each axis. Writes them to `file` (CSV) first.
  std::unique_ptr<HeatModel> cloud(const Teuchos::RCP<const Communicator>& communicator, const std::string& file) const;
};

/// A weld-like temperature of each source: a hot spot, a warm trace, and 293 K elsewhere.
VectorView weld_state(const Model& model);

}  // namespace kiln::bench
