#pragma once

namespace kiln {

/// A part of a run with a trial space of its own. It serves the steps that end after the window before it has ended, up
/// to `end`; the last window also serves what comes later.
struct TimeWindow {
  double end;  ///< s
  int first;   ///< place in x of its first coordinate
  int size;    ///< M, its number of coordinates
};

}  // namespace kiln
