/// A shared library that is no plugin. None of its code may run.
#include <cstdlib>

[[maybe_unused]] static const int leave = (std::abort(), 0);
