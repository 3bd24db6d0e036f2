# kiln_test(NAME suite SOURCES a.cpp … [RANKS 1 2 …])
# One GoogleTest executable, registered once for each rank count; every count runs all its tests.
find_package(GTest REQUIRED)
set(KILN_MPI_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1
    # Ranks of one machine: the search for networks would take a third of each start.
    OMPI_MCA_pml=ob1 OPENBLAS_NUM_THREADS=1)

# Objects of executables, compiled as those themselves are, or they could not share precompiled headers.
function(kiln_test_objects name)
  add_library(${name} OBJECT ${ARGN})
  target_link_libraries(${name} PRIVATE kiln_library GTest::gtest)
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${name} PRIVATE -fPIE ${KILN_QUICKLY_COMPILED})
endfunction()

if(NOT TARGET kiln_test_main)
  kiln_test_objects(kiln_test_main ${PROJECT_SOURCE_DIR}/unit_tests/main.cpp)
  kiln_precompile(kiln_test_main ALSO <gtest/gtest.h>)
endif()

# kiln_test_cases(name a.cpp …): sources that several tests share, compiled once. A test takes them as a source:
# $<TARGET_OBJECTS:name>.
function(kiln_test_cases name)
  kiln_test_objects(${name} ${ARGN})
  kiln_precompile(${name} FROM kiln_test_main)
endfunction()

function(kiln_test)
  cmake_parse_arguments(TEST "" "NAME;TIMEOUT" "SOURCES;RANKS" ${ARGN})
  if(NOT TEST_RANKS)
    set(TEST_RANKS 1)
  endif()
  if(NOT TEST_TIMEOUT)
    math(EXPR TEST_TIMEOUT "300 * ${KILN_SLOWER}")
  endif()
  add_executable(test_${TEST_NAME} ${TEST_SOURCES} $<TARGET_OBJECTS:kiln_test_main> ${KILN_PROGRAM_OBJECTS})
  target_link_libraries(test_${TEST_NAME} PRIVATE kiln_library GTest::gtest)
  target_compile_options(test_${TEST_NAME} PRIVATE ${KILN_QUICKLY_COMPILED})
  kiln_precompile(test_${TEST_NAME} FROM kiln_test_main)
  foreach(ranks IN LISTS TEST_RANKS)
    if(ranks EQUAL 1)
      add_test(NAME ${TEST_NAME} COMMAND test_${TEST_NAME})
      set(test ${TEST_NAME})
    else()
      set(test ${TEST_NAME}.${ranks}_ranks)
      add_test(NAME ${test} COMMAND ${MPIEXEC_EXECUTABLE} -n ${ranks} $<TARGET_FILE:test_${TEST_NAME}>)
    endif()
    set_tests_properties(${test} PROPERTIES ENVIRONMENT "${KILN_MPI_ENVIRONMENT}" TIMEOUT ${TEST_TIMEOUT} PROCESSORS ${ranks})
  endforeach()
endfunction()
