/// A plugin that calls a function nobody has.
#include "framework/plugin/Plugin.hpp"

KILN_PLUGIN();

int a_function_nobody_has();
int call_it() { return a_function_nobody_has(); }
