# `cmake --install`: the program, the library, the headers, and a package that find_package(Kiln) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
# framework/plugin/Plugins.cpp looks for plugins there, beside the library.
set(KILN_PLUGIN_DIR ${CMAKE_INSTALL_LIBDIR}/kiln/plugins)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Kiln)

file(RELATIVE_PATH from_program_to_library /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set_target_properties(kiln PROPERTIES INSTALL_RPATH "$ORIGIN/${from_program_to_library}" INSTALL_RPATH_USE_LINK_PATH ON)
set_target_properties(kiln_library PROPERTIES INSTALL_RPATH "$ORIGIN" INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS kiln RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS kiln_library EXPORT KilnTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT KilnTargets NAMESPACE Kiln:: DESTINATION ${package_dir})

foreach(header IN LISTS KILN_HEADERS)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kiln/${folder})
endforeach()
install(FILES ${KILN_INTERFACE_HEADER} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kiln/framework/plugin)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/KilnConfig.cmake.in ${PROJECT_BINARY_DIR}/KilnConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/KilnConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/KilnConfig.cmake ${PROJECT_BINARY_DIR}/KilnConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/KilnDependencies.cmake ${PROJECT_SOURCE_DIR}/cmake/KilnAddPlugin.cmake
        DESTINATION ${package_dir})
