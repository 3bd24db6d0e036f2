#pragma once

#include <array>
#include <optional>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

using Point = std::array<double, 3>;  ///< x, y, z in m

/// An axis-aligned box, in m.
struct Box {
  Point lower;
  Point upper;
};

/// The particles of a part, in the order of their global ids; the same on every rank.
struct ParticleCloud {
  std::vector<Point> positions;
  std::vector<double> volumes;       ///< V_i in m³
  std::vector<double> heated_areas;  ///< A_i of Eq. 7 in m²; 0 for a particle the heat source does not reach
  double spacing = 0.0;              ///< in m; the smoothing length counts in it
  /// Faces of the part when each particle is the centre of a cell and the cells fill the box, so that mirroring the
  /// particles in the faces continues them. Absent otherwise.
  std::optional<Box> faces;
};

/// Where the particles of a model come from.
class Particles {
 public:
  struct Context {
    Teuchos::RCP<const Communicator> communicator;
  };
  static constexpr const char* category = "particles";

  virtual ~Particles() = default;
  /// Collective.
  virtual ParticleCloud cloud() const = 0;
};

}  // namespace kiln
