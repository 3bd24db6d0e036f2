#pragma once

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <string>
#include <vector>

#include "framework/base/NearestParticle.hpp"
#include "framework/method/Method.hpp"

namespace kiln {

/// A point whose state is told, and the particle that tells it.
struct Probe {
  std::string name;
  std::array<double, 3> point;  ///< in m, as asked for
  NearestParticle particle;
};

/// The probes of a checked block `probes`. Throws InputError that lists all that lie outside the method's particles.
/// Collective.
std::vector<Probe> find_probes(const Teuchos::ParameterList& list, const Method& method);

}  // namespace kiln
