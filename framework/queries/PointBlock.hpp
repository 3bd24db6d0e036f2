#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/method/SolveTotals.hpp"
#include "framework/model/ParameterPoints.hpp"

namespace kiln {

class TimeScheme;

/// How the run of one point went.
struct PointOutcome : SolveTotals {
  std::string divergence;  ///< what DivergenceError says; empty: it did not diverge
};

/// Several parameter points of a method that advance through the same steps together, each with its own unknown. A
/// point's answer is that of a run of its own, to round-off, and does not depend on the other points of the block.
class PointBlock {
 public:
  virtual ~PointBlock() = default;
  /// Begins at t = 0, at points of the number the block was made for. What it has made for other points before, it
  /// uses again.
  virtual void start(const ParameterPoints& points) = 0;
  /// Advances all points to `time`, the end of step `step`. A point that diverges is marked in its outcome and left
  /// behind; the others go on.
  virtual void advance(int step, double time) = 0;
  /// The states of the places asked for. u: points by places × components; without meaning for points left behind.
  virtual void tell(MatrixView u) const = 0;
  virtual const std::vector<PointOutcome>& outcomes() const = 0;
};

/// A method that can advance points together offers this beside Method.
class AdvancesTogether {
 public:
  struct Request {
    std::size_t points;              ///< how many
    const TimeScheme& scheme;        ///< of this method; how a step is taken
    double step;                     ///< Δt in s
    std::vector<LocalIndex> places;  ///< among the method's particles(): whose states are to be told
  };
  virtual ~AdvancesTogether() = default;
  /// Uses the method's models and bases: it must not outlive the method, and only one block may advance at a time.
  /// Throws InputError, by name, for what the input asks for and points together do not offer. Only where the method
  /// is on one rank.
  virtual std::unique_ptr<PointBlock> point_block(Request request) = 0;
};

}  // namespace kiln
