/// Says it was built against another Kiln. None of its code may run.
#include <cstdlib>

#include "framework/plugin/Plugin.hpp"

extern "C" {
extern const char kiln_plugin[];
const char kiln_plugin[] = KILN_ABI_MARK "Kiln 0.0.9 (headers 0123456789ab, compiler 4.2.1, Trilinos 12.0)";
}

[[maybe_unused]] static const int leave = (std::abort(), 0);
