# `cmake --install`: the programs, what they read (robots, problems, line-ups, message types), documents and examples, and
# the CMake package planbench: find_package(planbench), planbench::messaging (a planner's node and the messages), planbench::planning,
# planbench::collision (the checkers) and what those stand on. `cpack` in the build folder makes a Debian package of it.
include(CMakePackageConfigHelpers)

set(package_rooms common geometry robot_model scene collision planning messaging)
foreach(room ${package_rooms})
  set_target_properties(planbench_${room} PROPERTIES EXPORT_NAME ${room})
  install(TARGETS planbench_${room} EXPORT planbench)
  install(DIRECTORY ${room} DESTINATION include/planbench FILES_MATCHING PATTERN "*.h")
endforeach()
foreach(part options lcmtypes)
  set_target_properties(planbench_${part} PROPERTIES EXPORT_NAME ${part})
  install(TARGETS planbench_${part} EXPORT planbench)
endforeach()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/planbench)
install(EXPORT planbench NAMESPACE planbench:: DESTINATION ${package_folder} FILE planbenchTargets.cmake)
configure_package_config_file(cmake/planbenchConfig.cmake.in ${CMAKE_BINARY_DIR}/planbenchConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
# Until 1.0 any minor version may change messages and headers.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/planbenchConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/planbenchConfig.cmake ${CMAKE_BINARY_DIR}/planbenchConfigVersion.cmake
              cmake/FindLCM.cmake
        DESTINATION ${package_folder})

install(PROGRAMS scripts/planbench_slurm DESTINATION lib/planbench)
# Beside each other as in the tree, so that the links of the documents lead somewhere.
install(DIRECTORY robots problems lineups lcmtypes docs DESTINATION share/planbench PATTERN CMakeLists.txt EXCLUDE)
install(DIRECTORY examples DESTINATION share/planbench USE_SOURCE_PERMISSIONS PATTERN build EXCLUDE)
install(FILES README.md CONTRIBUTING.md CHANGELOG.md LICENSE packages.txt DESTINATION share/planbench)
install(FILES LICENSE DESTINATION share/doc/planbench RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "planbench's maintainers <planbench@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_STRIP_FILES ON)
include(CPack)
