#pragma once

#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <vector>

#include "framework/registry/Specification.hpp"
#include "rom/linear_algebra/Dense.hpp"
#include "rom/pod/Snapshots.hpp"

namespace kiln {

/// The block `reduction.windows`: into which time windows a training cuts the run.
struct WindowSettings {
  std::optional<int> count;     ///< that many, of equal length
  std::optional<int> steps;     ///< of that many steps each, up to whole snapshots; the last may be shorter
  std::optional<double> error;  ///< as few as hold this error with the basis rank asked for
  static Specification specification();
  /// `list` may be null: one window.
  static WindowSettings of(const Teuchos::ParameterList* list);
};

/// The snapshots' inner products, from which those of any window's increments follow without touching the snapshots.
class WindowCosts {
 public:
  /// `snapshots`: this rank's rows of u_n − u_0. Collective.
  WindowCosts(const Snapshots& snapshots, const Communicator& communicator);

  /// How far the best basis of `rank` vectors stays from the increments u_n − u_begin, begin < n ≤ end, of a window:
  /// root mean square over its snapshots of ‖(I − ΦΦᵀ)(u_n − u_begin)‖, relative to the largest ‖u_n − u_0‖ of all
  /// snapshots. Snapshot 0 is the initial state.
  double projection_error(int begin, int end, int rank) const;
  int snapshots() const { return static_cast<int>(products_.extent(0)); }

 private:
  double product(int n, int m) const { return n == 0 || m == 0 ? 0.0 : products_(n - 1, m - 1); }
  MatrixView products_;
  double largest_ = 0.0;
};

/// Numbers of the snapshots at which windows end, ascending; the last one is costs.snapshots(). Each window is as long
/// as its projection error with `rank` vectors allows.
std::vector<int> windows_within(const WindowCosts& costs, int rank, double error);

}  // namespace kiln
