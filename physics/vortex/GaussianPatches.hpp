#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

#include "framework/registry/Specification.hpp"
#include "physics/vortex/Vortices.hpp"

namespace kiln {

/// A vortex of smooth vorticity ω = Γ/(πa²) exp(−r²/a²).
struct GaussianPatch {
  double x;            ///< of its centre, in m
  double y;            ///< m
  double radius;       ///< a in m
  double circulation;  ///< Γ in m²/s
};

/// How patches become particles: on a regular grid of spacing h, with nodes at ((i + 1/2) h, (j + 1/2) h), those nodes
/// that lie within `cutoff` radii of a patch, each with the circulation ω h². Ids run along x, then y.
class PatchGrid {
 public:
  /// Keys `spacing` or `count`, and `cutoff`.
  static void add_entries(Specification& specification);
  explicit PatchGrid(const Teuchos::ParameterList& list);

  /// With `count`, the widest spacing that gives at least so many particles, found to 1e-12 of it. Throws InputError
  /// for patches that are not finite and for grids of more than 1e8 nodes.
  VortexCloud cloud(const std::vector<GaussianPatch>& patches) const;

 private:
  std::string path_;
  double spacing_ = 0.0;  ///< 0: from count_
  int count_ = 0;
  double cutoff_;
};

}  // namespace kiln
