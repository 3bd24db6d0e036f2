# kiln_self_contained_headers: compiles each header alone, so that including one never depends on what came before it.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/framework/*.hpp ${PROJECT_SOURCE_DIR}/physics/*.hpp ${PROJECT_SOURCE_DIR}/rom/*.hpp)
set(header_sources)
foreach(header IN LISTS headers)
  string(REPLACE "/" "_" name ${header})
  set(source ${PROJECT_BINARY_DIR}/self_contained/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n#include \"${header}\"\n" @ONLY)
  list(APPEND header_sources ${source})
endforeach()
add_library(kiln_self_contained_headers OBJECT EXCLUDE_FROM_ALL ${header_sources})
target_link_libraries(kiln_self_contained_headers PRIVATE kiln_options)
