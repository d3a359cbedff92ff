# What `cmake --install` and `cpack` take. Components: program; development, for find_package(bedload); bundled, the
# shared libraries of a tarball that runs anywhere; mpi, the plug-in; python, the wheel (python.cmake).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS bedload RUNTIME_DEPENDENCY_SET libraries COMPONENT program)
install(FILES LICENSE CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/bedload COMPONENT program)
set(BEDLOAD_LICENCES "" CACHE PATH "Folder with the licences of what packages have compiled in or bundled")
if(BEDLOAD_LICENCES)
  install(DIRECTORY ${BEDLOAD_LICENCES} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/bedload COMPONENT program)
  install(DIRECTORY ${BEDLOAD_LICENCES} DESTINATION bedload COMPONENT python EXCLUDE_FROM_ALL)
endif()
install(CODE "execute_process(COMMAND $<TARGET_FILE:bedload> man OUTPUT_FILE ${CMAKE_BINARY_DIR}/bedload.1
                              COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND $<TARGET_FILE:bedload> completion bash OUTPUT_FILE ${CMAKE_BINARY_DIR}/bedload.bash
                COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/bedload.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/bedload.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME bedload COMPONENT program)
# All but what belongs to the C library and the GPU driver.
install(RUNTIME_DEPENDENCY_SET libraries DESTINATION lib COMPONENT bundled EXCLUDE_FROM_ALL
        PRE_EXCLUDE_REGEXES "^(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|util|anl|nsl|cuda))\\.so")

# The plug-in belongs to the MPI of a site, so no package has it: cmake --install <build> --component mpi.
if(TARGET bedload_mpi)
  install(TARGETS bedload_mpi LIBRARY DESTINATION lib COMPONENT mpi EXCLUDE_FROM_ALL)
endif()

# bedload::bedload: the interface of include/bedload, without what is compiled for one precision or device.
add_library(bedload_interface INTERFACE)
set_target_properties(bedload_interface PROPERTIES EXPORT_NAME bedload)
target_link_libraries(bedload_interface INTERFACE bedload_host bedload_device)
target_include_directories(bedload_interface INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(bedload_interface INTERFACE cxx_std_20)
set(solvers "")
foreach(precision IN LISTS BEDLOAD_PRECISIONS)
  list(APPEND solvers bedload_${precision}_cpu)
  if(BEDLOAD_CPU_DISPATCH)
    list(APPEND solvers bedload_${precision}_cpu_avx2_sealed)
  endif()
  if(BEDLOAD_CUDA)
    list(APPEND solvers bedload_${precision}_cuda)
  endif()
endforeach()
install(TARGETS bedload_interface bedload_headers bedload_host bedload_device ${solvers} EXPORT bedload
        ARCHIVE COMPONENT development)
install(DIRECTORY include/bedload/case include/bedload/geometry include/bedload/motion include/bedload/output
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bedload COMPONENT development)
install(FILES include/bedload/core/error.hpp include/bedload/core/vec.hpp include/bedload/core/fingerprint.hpp
              include/bedload/core/host_memory.hpp include/bedload/core/wall_kind.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bedload/core COMPONENT development)
install(FILES include/bedload/host_data.hpp include/bedload/simulation.hpp include/bedload/step_limits.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bedload COMPONENT development)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/bedload)
install(EXPORT bedload NAMESPACE bedload:: DESTINATION ${config} FILE bedload-targets.cmake COMPONENT development)
configure_file(tools/cmake/bedload-config.cmake.in bedload-config.cmake @ONLY)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/bedload-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/bedload-config.cmake ${CMAKE_BINARY_DIR}/bedload-config-version.cmake
        DESTINATION ${config} COMPONENT development)

# `cpack`: a .deb that takes libraries from the system, a tarball that brings its own.
set(CPACK_GENERATOR DEB TGZ)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # packages need no tests
set(CPACK_PACKAGE_NAME bedload)
set(CPACK_PACKAGE_CONTACT "The Bedload developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Grains in free-surface flow: SPH and DEM, coupled both ways")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libhdf5-dev, libfmt-dev, libtomlplusplus-dev")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/tools/cmake/cpack.cmake)
include(CPack)
