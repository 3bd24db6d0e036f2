#pragma once

#include <utility>

#include "framework/model/PointRates.hpp"
#include "rom/basis/TrialSpace.hpp"

namespace kiln {

/// An affine trial space at the coordinates of several points at once: u_p = g(x_p) = b_p + Φ û_p, one product of
/// matrices. The state b_p in which a point begins the space's window is kept.
///
/// x: points by coordinates of all windows; u: points by particles × components.
class PointStates {
 public:
  /// Throws std::logic_error for a trial space that is not affine.
  PointStates(std::size_t points, const TrialSpace& space);

  /// Takes b_p from the coordinates of windows past.
  void begin(ConstMatrixView x);
  /// Of the wanted points, and perhaps of others.
  void states(ConstMatrixView x, const PointMask& wanted, MatrixView u) const;
  /// Φ.
  ConstMatrixView tangent() const { return tangent_; }
  /// Entries of one point's state.
  std::size_t size() const { return beginning_.extent(1); }

 private:
  const TrialSpace& space_;
  ConstMatrixView tangent_;
  MatrixView beginning_;  ///< points by particles × components
};

/// The coordinates of a trial space's own window.
template <class View>
View own_coordinates(const View& x, const TrialSpace& space) {
  return Kokkos::subview(x, Kokkos::ALL, std::make_pair(space.first(), space.first() + space.size()));
}

}  // namespace kiln
