# framework/report/Build.hpp names what a binary was built from. The commit is read at build time, not at configure time, so
# that it is true of each build.
string(TOUPPER "${CMAKE_BUILD_TYPE}" KILN_BUILD_TYPE_UPPER)
get_target_property(KILN_OPTION_LIST kiln_options INTERFACE_COMPILE_OPTIONS)
list(JOIN KILN_OPTION_LIST " " KILN_OPTION_TEXT)
set(KILN_BUILD_FLAGS "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${KILN_BUILD_TYPE_UPPER}} ${KILN_OPTION_TEXT}")
string(REGEX REPLACE "-W[^ ]+ *" "" KILN_BUILD_FLAGS "${KILN_BUILD_FLAGS}")
string(STRIP "${KILN_BUILD_FLAGS}" KILN_BUILD_FLAGS)

set(KILN_GENERATED_DIR ${PROJECT_BINARY_DIR}/generated)
add_custom_target(kiln_build_facts
  BYPRODUCTS ${KILN_GENERATED_DIR}/BuildFacts.inc
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DOUTPUT=${KILN_GENERATED_DIR}/BuildFacts.inc
          -DVERSION=${PROJECT_VERSION} "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
          "-DBUILD_TYPE=${CMAKE_BUILD_TYPE}" "-DFLAGS=${KILN_BUILD_FLAGS}"
          -P ${PROJECT_SOURCE_DIR}/cmake/WriteBuildFacts.cmake
  VERBATIM)
