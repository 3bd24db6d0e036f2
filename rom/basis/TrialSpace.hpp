#pragma once

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The set of states that M generalised coordinates û can reach, told for a fixed list of particles: u ≈ g(û) (Eq. 13).
/// A reduced method holds one over its model's sources, for the equations, and one over the particles whose state it
/// tells. Arrays hold `components` values a particle, as a Model's.
class TrialSpace {
 public:
  virtual ~TrialSpace() = default;

  /// M.
  virtual int size() const = 0;
  /// u = g(û). coordinates: M; u: particles × components, overwritten. Does not allocate.
  virtual void state(ConstVectorView coordinates, VectorView u) const = 0;
  /// ∂g/∂û: particles × components by M. The view stays the trial space's, and true until the next call.
  virtual ConstMatrixView tangent(ConstVectorView coordinates) const = 0;
  /// Whether the tangent is the same everywhere.
  virtual bool affine() const = 0;
};

}  // namespace kiln
