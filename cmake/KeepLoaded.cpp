/// Part of programs built with sanitizers. Open MPI unloads its plugins before the program ends, and what they have
/// kept could no longer be told by the plugin's name (leak-suppressions.txt). So nothing is unloaded.
extern "C" int dlclose(void*) { return 0; }
