# kiln_options: language level, warnings, optimisation and include root of everything in this tree.
add_library(kiln_options INTERFACE)
target_compile_features(kiln_options INTERFACE cxx_std_17)
target_include_directories(kiln_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
target_compile_options(kiln_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wno-unknown-pragmas)
# What code is generated: plugins take the same (KilnAddPlugin.cmake).
set(KILN_CODE_OPTIONS
  # `#pragma omp simd` marks sums that may be reordered for vector units; nothing else of OpenMP is used.
  -fopenmp-simd
  # Kiln reads neither errno after a math function nor floating-point traps; NaN and infinity keep their meaning.
  -fno-math-errno -fno-trapping-math)
if(KILN_NATIVE)
  list(APPEND KILN_CODE_OPTIONS -march=native)
endif()
target_compile_options(kiln_options INTERFACE ${KILN_CODE_OPTIONS})
if(KILN_WARNINGS_AS_ERRORS)
  target_compile_options(kiln_options INTERFACE -Werror)
endif()
if(KILN_SANITIZE)
  target_compile_options(kiln_options INTERFACE -fsanitize=${KILN_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(kiln_options INTERFACE -fsanitize=${KILN_SANITIZE})
  add_library(kiln_keep_loaded OBJECT ${CMAKE_CURRENT_LIST_DIR}/KeepLoaded.cpp)
endif()
# How many times longer tests may take than in an optimised build.
set(KILN_SLOWER 1)
if(KILN_SANITIZE OR KILN_COVERAGE)
  set(KILN_SLOWER 8)
endif()
# What else a program of this tree consists of.
set(KILN_PROGRAM_OBJECTS $<$<TARGET_EXISTS:kiln_keep_loaded>:$<TARGET_OBJECTS:kiln_keep_loaded>>)
if(KILN_COVERAGE)
  # Several ranks of one test count into the same files.
  target_compile_options(kiln_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(kiln_options INTERFACE --coverage)
endif()
target_link_libraries(kiln_options INTERFACE kiln_dependencies)
# For tests, which take longer to compile than to run.
set(KILN_QUICKLY_COMPILED $<$<CONFIG:Release>:-O1>)
