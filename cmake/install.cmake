# What cmake --install installs: the library with its headers, for CMake and for pkg-config, and the command.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(FLAUNAY_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/flaunay)
# The folder of the headers, for users' CMake before 3.23, which does not support file sets.
install(TARGETS flaunay EXPORT flaunay-targets FILE_SET HEADERS INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET flaunay_cli)
  install(TARGETS flaunay_cli)
endif()
if(TARGET flaunay_printed)
  set(PRINTED ${PROJECT_BINARY_DIR}/printed)
  install(FILES ${PRINTED}/bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME flaunay OPTIONAL)
  install(FILES ${PRINTED}/zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _flaunay OPTIONAL)
  install(FILES ${PRINTED}/fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME flaunay.fish OPTIONAL)
  install(FILES ${PRINTED}/man DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 RENAME flaunay.1 OPTIONAL)
endif()
# The component mpi, with targets of its own, so that others need no MPI.
if(TARGET flaunay_mpi)
  install(TARGETS flaunay_mpi EXPORT flaunay-mpi-targets FILE_SET HEADERS INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT flaunay-mpi-targets NAMESPACE flaunay:: DESTINATION ${FLAUNAY_CONFIG_DIR})
endif()
if(TARGET flaunay_mpi_cli)
  install(TARGETS flaunay_mpi_cli)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT flaunay-targets NAMESPACE flaunay:: DESTINATION ${FLAUNAY_CONFIG_DIR})
configure_package_config_file(cmake/flaunay-config.cmake.in ${PROJECT_BINARY_DIR}/flaunay-config.cmake
                              INSTALL_DESTINATION ${FLAUNAY_CONFIG_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/flaunay-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/flaunay-config.cmake ${PROJECT_BINARY_DIR}/flaunay-config-version.cmake
        DESTINATION ${FLAUNAY_CONFIG_DIR})

# The paths in flaunay.pc are relative to the file, so that the installation can be moved.
file(RELATIVE_PATH PC_TO_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" PC_TO_PREFIX "${PC_TO_PREFIX}")
set(PC_LIBDIR "\${prefix}")
set(PC_INCLUDEDIR "\${prefix}")
cmake_path(APPEND PC_LIBDIR "${CMAKE_INSTALL_LIBDIR}")
cmake_path(APPEND PC_INCLUDEDIR "${CMAKE_INSTALL_INCLUDEDIR}")
set(PC_DEFINITIONS "")
if(NOT BUILD_SHARED_LIBS)
  set(PC_DEFINITIONS " -DFLAUNAY_STATIC")
endif()
list(TRANSFORM CMAKE_DL_LIBS PREPEND " -l" OUTPUT_VARIABLE PC_DL)
configure_file(cmake/flaunay.pc.in ${PROJECT_BINARY_DIR}/flaunay.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/flaunay.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
