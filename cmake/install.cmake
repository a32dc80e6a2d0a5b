# find_package(hdpstereo) brings the target opencv_hdpstereo.

install(TARGETS opencv_hdpstereo EXPORT hdpstereo-targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/opencv2 DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT hdpstereo-targets DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hdpstereo)
file(GENERATE OUTPUT "${CMAKE_BINARY_DIR}/hdpstereo-config.cmake" CONTENT
"include(CMakeFindDependencyMacro)
find_dependency(OpenCV ${OpenCV_VERSION})
include(\"\${CMAKE_CURRENT_LIST_DIR}/hdpstereo-targets.cmake\")
")
install(FILES "${CMAKE_BINARY_DIR}/hdpstereo-config.cmake" DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hdpstereo)

if(HDPSTEREO_PRELOAD)
  install(TARGETS hdpstereo_preload hdpstereo_adapters LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/hdpstereo)
  install(PROGRAMS "${CMAKE_BINARY_DIR}/preload/hdpstereo-run" DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
