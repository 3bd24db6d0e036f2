/// A plugin whose own initialiser throws.
#include <stdexcept>

#include "framework/plugin/Plugin.hpp"

KILN_PLUGIN();

static int fail() { throw std::runtime_error("no licence for this machine"); }
[[maybe_unused]] static const int failed = fail();
