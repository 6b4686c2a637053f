# What `cmake --install` and `./dmise package` put where. Component `runtime` is what the package and the container image
# hold; `development` is what other projects need to use core/ and clients/cpp.
include(CMakePackageConfigHelpers)

foreach(kind cameras catalogues materials models scenarios sites)
  install(DIRECTORY launch/${kind} DESTINATION share/dmise/launch COMPONENT runtime)
endforeach()
install(DIRECTORY proto/dmise DESTINATION share/dmise/proto COMPONENT runtime)
install(PROGRAMS launch/setup/fetch-tycho2.sh launch/setup/fetch_source.py DESTINATION share/dmise/launch/setup COMPONENT runtime)
install(PROGRAMS bench/validation/places.py DESTINATION share/dmise/validation COMPONENT runtime)
install(FILES launch/setup/tycho2.txt DESTINATION share/dmise/launch/setup COMPONENT runtime)
install(FILES LICENSE NOTICE CITATION.cff DESTINATION share/doc/dmise COMPONENT runtime)
install(FILES launch/package/copyright DESTINATION share/doc/dmise COMPONENT runtime)

get_target_property(python_dir dmise_proto_python PYTHON_DIR)
install(DIRECTORY ${python_dir}/dmise DESTINATION lib/python3/dist-packages COMPONENT runtime PATTERN __pycache__ EXCLUDE
        PATTERN _engine* EXCLUDE PATTERN lib EXCLUDE)

install(DIRECTORY ${CMAKE_BINARY_DIR}/dashboard DESTINATION share/dmise COMPONENT runtime OPTIONAL)  # where npm made it

# Manual pages and completions, printed by the programs that they are of.
get_property(programs GLOBAL PROPERTY DMISE_PROGRAMS)
set(manuals ${CMAKE_BINARY_DIR}/share)
add_custom_command(OUTPUT ${manuals}/made
  COMMAND ${PROJECT_SOURCE_DIR}/launch/package/manuals.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${manuals} ${CMAKE_CROSSCOMPILING_EMULATOR}
  COMMAND ${CMAKE_COMMAND} -E touch ${manuals}/made
  DEPENDS ${programs} launch/package/manuals.sh COMMENT "manual pages" VERBATIM)
add_custom_target(manuals ALL DEPENDS ${manuals}/made)
if(NOT DMISE_SANITIZE)
  add_dependencies(programs manuals)
endif()
install(DIRECTORY ${manuals}/man ${manuals}/bash-completion ${manuals}/zsh ${manuals}/dmise DESTINATION share COMPONENT runtime)

install(DIRECTORY core DESTINATION include/dmise COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "*.inc")
set(package_dir lib/cmake/dmise)
install(EXPORT dmise NAMESPACE dmise:: FILE dmiseTargets.cmake DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(cmake/dmiseConfig.cmake.in ${CMAKE_BINARY_DIR}/dmiseConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/dmiseConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/dmiseConfig.cmake ${CMAKE_BINARY_DIR}/dmiseConfigVersion.cmake
              cmake/InstalledPackages.cmake
        DESTINATION ${package_dir} COMPONENT development)

# The package, of the release that it is made on: 1.0.0~deb13.
cmake_host_system_information(RESULT release QUERY DISTRIB_ID DISTRIB_VERSION_ID)
list(JOIN release "" release)
string(REPLACE debian deb release "${release}")
set(CPACK_GENERATOR DEB)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/PackageNeeds.cmake)
set(CPACK_DMISE_SOURCE_DIR ${PROJECT_SOURCE_DIR})
set(CPACK_DMISE_BINARY_DIR ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION}~${release})
set(CPACK_PACKAGE_NAME dmise)
set(CPACK_PACKAGE_CONTACT "The DMISE developers <dmise@dmise.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulator of optical sensors that watch near-Earth space")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"A network of telescopes and cameras, on the ground and in orbit, renders what it
sees of satellites, stars and sky, and detects what moves. Begin with `dmise demo`.")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL runtime)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME dmise)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_RUNTIME_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "man-db, python3-numpy, python3-protobuf, python3-zmq")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/launch/package/prerm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
include(CPack)
