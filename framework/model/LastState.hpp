#pragma once

#include "framework/base/Loop.hpp"

namespace kiln {

/// Remembers the state that something was computed from. Newton's method asks for a step's first rate at the state in
/// which the step before ended, and for the Jacobian at one it has just asked the rate of: what was computed then still
/// holds.
class LastState {
 public:
  explicit LastState(std::size_t size = 0) : u_("last state", size) {}

  bool is(const ConstVectorView& u) const { return known_ && same_values(u, u_); }
  /// Once what u was for has been computed.
  void remember(const ConstVectorView& u) {
    copy_values(u, u_);
    known_ = true;
  }

 private:
  VectorView u_;
  bool known_ = false;
};

}  // namespace kiln
