# Run at each build: writes the commit and the flags as C++ constants, touching the file only when they changed.
execute_process(COMMAND git describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE_DIR}
                OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT COMMIT)
  set(COMMIT "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [=[
constexpr const char* version = "@VERSION@";
constexpr const char* commit = "@COMMIT@";
constexpr const char* compiler = "@COMPILER@";
constexpr const char* build_type = "@BUILD_TYPE@";
constexpr const char* flags = "@FLAGS@";
]=] @ONLY)
