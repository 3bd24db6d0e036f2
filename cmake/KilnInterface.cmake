# framework/plugin/Interface.hpp: the version of Kiln and a hash of all its headers. A plugin carries both, so that one built
# against other headers is refused instead of crashing.
file(GLOB_RECURSE KILN_HEADERS RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/framework/*.hpp ${PROJECT_SOURCE_DIR}/physics/*.hpp ${PROJECT_SOURCE_DIR}/rom/*.hpp)
set(KILN_INTERFACE_HEADER ${KILN_GENERATED_DIR}/framework/plugin/Interface.hpp)
list(TRANSFORM KILN_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE header_files)
file(WRITE ${PROJECT_BINARY_DIR}/headers.txt.new "${KILN_HEADERS}")
file(COPY_FILE ${PROJECT_BINARY_DIR}/headers.txt.new ${PROJECT_BINARY_DIR}/headers.txt ONLY_IF_DIFFERENT)
add_custom_command(
  OUTPUT ${KILN_INTERFACE_HEADER}
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DHEADERS=${PROJECT_BINARY_DIR}/headers.txt
          -DVERSION=${PROJECT_VERSION} -DOUTPUT=${KILN_INTERFACE_HEADER}
          -P ${PROJECT_SOURCE_DIR}/cmake/WriteInterface.cmake
  DEPENDS ${header_files} ${PROJECT_BINARY_DIR}/headers.txt ${PROJECT_SOURCE_DIR}/cmake/WriteInterface.cmake
  VERBATIM)
add_custom_target(kiln_interface DEPENDS ${KILN_INTERFACE_HEADER})
