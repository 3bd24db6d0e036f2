#pragma once

#include <memory>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The set of states that generalised coordinates can reach, told for a fixed list of particles: u ≈ g(x) (Eq. 13). A
/// reduced method holds one over its model's sources, for the equations, and one over the particles whose state it
/// tells. Arrays hold `components` values a particle, as a Model's.
///
/// The vector x holds the coordinates of all time windows one after the other. A space belongs to one window: its own
/// coordinates û are x[first(), first() + size()), those before them are what earlier windows have left behind, and
/// those after them it does not read.
class TrialSpace {
 public:
  virtual ~TrialSpace() = default;

  virtual int first() const = 0;
  /// M, the number of its own coordinates.
  virtual int size() const = 0;
  /// u = g(x). u: particles × components, overwritten. Does not allocate.
  virtual void state(ConstVectorView x, VectorView u) const = 0;
  /// ∂g/∂û: particles × components by M. The view stays the trial space's, and true until the next call.
  virtual ConstMatrixView tangent(ConstVectorView x) const = 0;
  /// Whether the tangent is the same everywhere.
  virtual bool affine() const = 0;
  /// The same space, told for some of its particles only: places in its list.
  virtual std::unique_ptr<TrialSpace> restricted(const std::vector<LocalIndex>& particles, int components) const = 0;
};

}  // namespace kiln
