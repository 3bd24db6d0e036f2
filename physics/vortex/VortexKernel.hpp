#pragma once

#include <cstddef>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/Parameters.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {

/// Vortices that act on every target, component by component. Places from `count` to `padded`, a multiple of the lanes,
/// hold vortices without circulation.
struct VortexArrays {
  const double* x;            ///< m
  const double* y;            ///< m
  const double* circulation;  ///< m²/s
  LocalIndex count;
  LocalIndex padded;
};

/// A list of vortices for each target. Lists fill whole lanes, with vortices without circulation at their ends.
struct VortexLists {
  const double* points;        ///< x and y of each source in m; the targets are the first ones
  const std::size_t* offsets;  ///< targets + 1
  const LocalIndex* sources;   ///< of each pair: where among `points` the x of its source stands
  const double* circulations;  ///< of each pair, in m²/s
};

/// Columns of tangents v: x and y of each particle in turn, each column `stride` numbers after the one before.
template <class Number>
struct Tangents {
  Number* values;
  std::size_t stride;
  int columns;
};

/// The columns of Tangents at the places of VortexArrays: of column c, x at x[c · stride + place], y likewise.
struct TangentArrays {
  const double* x;
  const double* y;
  std::size_t stride;
};

/// A regularised Biot–Savart kernel K(r) = q(|r|²) r⊥/(2π) and the sums over pairs that need it at their innermost. All
/// pointers are to the memory of the default execution space. `factor` is what a sum is multiplied by, µ/(2π).
class VortexKernel {
 public:
  using Context = NoContext;
  static constexpr const char* category = "vortex kernel";

  VortexKernel() = default;
  // Live parameters point into the object.
  VortexKernel(const VortexKernel&) = delete;
  VortexKernel& operator=(const VortexKernel&) = delete;
  virtual ~VortexKernel() = default;

  /// factor Σ_j Γ_j q r⊥, r = x_i − x_j, for `count` targets. targets: x and y of each in m; velocities: u and v of
  /// each in m/s, overwritten. A vortex at the target itself adds nothing.
  virtual void velocities(const VortexArrays& vortices, const double* targets, LocalIndex count, double factor,
                          double* velocities) const = 0;
  virtual void velocities(const VortexLists& lists, LocalIndex count, double factor, double* velocities) const = 0;

  /// ∂u_i/∂x_i and ∂v_i/∂y_i in 1/s.
  virtual void diagonal(const VortexArrays& vortices, const double* targets, LocalIndex count, double factor,
                        double* diagonal) const = 0;
  virtual void diagonal(const VortexLists& lists, LocalIndex count, double factor, double* diagonal) const = 0;

  /// Derivative of the velocities along tangents: factor Σ_j Γ_j D(q r⊥)(v_i − v_j). `own` holds the tangents of the
  /// targets, `sources` those of the vortices.
  virtual void apply(const VortexArrays& vortices, const TangentArrays& sources, const double* targets,
                     LocalIndex count, const Tangents<const double>& own, double factor,
                     const Tangents<double>& products) const = 0;
  /// `tangents`: of all sources of the lists.
  virtual void apply(const VortexLists& lists, LocalIndex count, const Tangents<const double>& tangents, double factor,
                     const Tangents<double>& products) const = 0;

  Parameters& parameters() { return parameters_; }
  const Parameters& parameters() const { return parameters_; }

 protected:
  Parameters parameters_;
};

}  // namespace kiln
