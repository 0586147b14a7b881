# `cmake --install`: the static library including OpenSubdiv, its headers, licenses, and the files for
# find_package(stiv). The wheel, made by a full install of the same build, omits them.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(in_wheel "")
if(SKBUILD)
  set(in_wheel EXCLUDE_FROM_ALL)
endif()
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/stiv)

set_target_properties(stiv_core PROPERTIES EXPORT_NAME core OUTPUT_NAME stiv)
install(TARGETS stiv_core EXPORT stivTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development ${in_wheel})
install(EXPORT stivTargets NAMESPACE stiv:: DESTINATION ${config_folder} COMPONENT development ${in_wheel})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/native/include/stiv DESTINATION include COMPONENT development ${in_wheel})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/stiv COMPONENT development ${in_wheel})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/licenses DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/stiv
        COMPONENT development ${in_wheel})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/stivConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/stivConfig.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/stivConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/stivConfig.cmake ${PROJECT_BINARY_DIR}/stivConfigVersion.cmake
        DESTINATION ${config_folder} COMPONENT development ${in_wheel})
