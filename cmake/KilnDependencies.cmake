# Every library Kiln links, in one interface target: kiln_dependencies. The Debian packages that hold them are listed in
# debian-packages.txt beside this file.
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Tpetra CONFIG REQUIRED)
find_package(Belos CONFIG REQUIRED)
find_package(KokkosKernels CONFIG REQUIRED)
find_package(Sacado CONFIG REQUIRED)
find_package(yaml-cpp CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(muparser CONFIG REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(PkgConfig REQUIRED)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "HDF5 at ${HDF5_INCLUDE_DIRS} is a serial build; Kiln needs a parallel one (Debian: libhdf5-openmpi-dev)")
endif()
# The same libblas.so.3 and liblapack.so.3 as Trilinos, whichever Debian's alternatives choose (OpenBLAS here): naming
# libopenblas itself would load a second copy with a second pool of threads.
set(BLA_VENDOR Generic)
find_package(LAPACK REQUIRED)

add_library(kiln_dependencies INTERFACE)
target_include_directories(kiln_dependencies SYSTEM INTERFACE ${Belos_INCLUDE_DIRS} ${Belos_TPL_INCLUDE_DIRS}
                                                              ${Tpetra_INCLUDE_DIRS} ${Sacado_INCLUDE_DIRS}
                                                              ${HDF5_INCLUDE_DIRS} ${YAML_CPP_INCLUDE_DIR})
target_link_libraries(kiln_dependencies INTERFACE
  trilinos_belostpetra trilinos_belos ${Tpetra_LIBRARIES}
  ${HDF5_LIBRARIES} ${YAML_CPP_LIBRARIES} LAPACK::LAPACK MPI::MPI_CXX fmt::fmt nlohmann_json::nlohmann_json CLI11::CLI11
  muparser::muparser PkgConfig::XXHASH OpenSSL::Crypto ${CMAKE_DL_LIBS})
# Open MPI's deprecated C++ bindings are not used; leaving them out saves a library at run time.
target_compile_definitions(kiln_dependencies INTERFACE OMPI_SKIP_MPICXX=1)
