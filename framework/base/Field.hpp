#pragma once

#include <string>

namespace kiln {

/// One component of a particle's state, e.g. {"temperature", "K"}.
struct Field {
  std::string name;
  std::string unit;
  bool origin_is_free =
      false;  ///< as of a position: only differences of values mean something, and errors relate to them
};

}  // namespace kiln
