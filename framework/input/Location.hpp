#pragma once

#include <string>

namespace kiln {

/// A place in an input file, 1-based, columns in bytes; line 0: not in a file (an override).
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", or the file alone for line 0.
std::string to_string(const Location& location);

}  // namespace kiln
