# What other projects find: by find_package(hdpstereo) after an installation, or with hdpstereo_DIR=<this build>; or by
# pkg-config after an installation.

# Replaces @NAME@ in a file, and what generator expressions stand for.
function(generate_from template output)
  configure_file(${template} "${PROJECT_BINARY_DIR}/templates/${output}" @ONLY)
  file(GENERATE OUTPUT "${PROJECT_BINARY_DIR}/${output}" INPUT "${PROJECT_BINARY_DIR}/templates/${output}")
endfunction()

include(CMakePackageConfigHelpers)
configure_file(cmake/hdpstereo-config.cmake.in "${PROJECT_BINARY_DIR}/hdpstereo-config.cmake" @ONLY)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/hdpstereo-config-version.cmake" COMPATIBILITY SameMajorVersion)
export(TARGETS opencv_hdpstereo FILE "${PROJECT_BINARY_DIR}/hdpstereo-targets.cmake")

file(RELATIVE_PATH pkgconfig_prefix "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
string(REGEX REPLACE "/$" "" pkgconfig_prefix "${pkgconfig_prefix}")
string(REGEX REPLACE "([^;]+)" "-l\\1" pkgconfig_libraries "${public_libraries}")
string(REPLACE ";" " " pkgconfig_libraries "${pkgconfig_libraries}")
string(REGEX REPLACE "([^;]+)" "-I\\1" pkgconfig_includes "${OpenCV_INCLUDE_DIRS}")
string(REPLACE ";" " " pkgconfig_includes "${pkgconfig_includes}")
generate_from(cmake/hdpstereo.pc.in hdpstereo.pc)

if(NOT HDPSTEREO_INSTALL)
  return()
endif()
install(TARGETS opencv_hdpstereo EXPORT hdpstereo-targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/opencv2 DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(config_directory ${CMAKE_INSTALL_LIBDIR}/cmake/hdpstereo)
install(EXPORT hdpstereo-targets DESTINATION ${config_directory})
install(FILES "${PROJECT_BINARY_DIR}/hdpstereo-config.cmake" "${PROJECT_BINARY_DIR}/hdpstereo-config-version.cmake"
  DESTINATION ${config_directory})
install(FILES "${PROJECT_BINARY_DIR}/hdpstereo.pc" DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(HDPSTEREO_PRELOAD)
  install(TARGETS hdpstereo_preload hdpstereo_adapters LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/hdpstereo)
  install(PROGRAMS "${PROJECT_BINARY_DIR}/preload/hdpstereo-run" DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
