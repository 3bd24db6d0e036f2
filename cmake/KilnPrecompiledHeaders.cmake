# kiln_precompile(TARGET [FROM OTHER] [ALSO <a.hpp> …]): headers of other libraries that most sources read, read once.
# FROM: those of a target with the same options. ALSO: what most sources of this target read besides. Sources include
# what they use all the same; the target self-contained headers goes without.
option(KILN_PRECOMPILED_HEADERS "Read other libraries' headers once" ON)

function(kiln_precompile target)
  cmake_parse_arguments(HEADERS "" "FROM" "ALSO" ${ARGN})
  if(NOT KILN_PRECOMPILED_HEADERS)
    return()
  endif()
  if(HEADERS_FROM)
    target_precompile_headers(${target} REUSE_FROM ${HEADERS_FROM})
    return()
  endif()
  target_precompile_headers(${target} PRIVATE
    <Kokkos_Core.hpp> <Teuchos_Comm.hpp> <Teuchos_CommHelpers.hpp> <Teuchos_ParameterList.hpp> <Teuchos_RCP.hpp>
    <Tpetra_CrsMatrix_decl.hpp> <Tpetra_Import_decl.hpp> <Tpetra_Map.hpp> <Tpetra_MultiVector_decl.hpp>
    <Tpetra_Operator.hpp> <Tpetra_Vector_decl.hpp> <fmt/format.h>
    <algorithm> <cmath> <filesystem> <functional> <map> <memory> <string> <vector> ${HEADERS_ALSO})
endfunction()
