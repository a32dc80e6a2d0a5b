# OpenCV's test framework, the target opencv_ts, from OPENCV_SOURCE_DIR: it is in no Debian package.

if(NOT EXISTS "${OPENCV_SOURCE_DIR}/modules/ts/include/opencv2/ts.hpp")
  message(FATAL_ERROR "OPENCV_SOURCE_DIR=${OPENCV_SOURCE_DIR} is not OpenCV's source: it has no modules/ts")
endif()
find_package(Threads REQUIRED)

# It reads three headers that OpenCV's build generates; empty ones will do, and leave out what is optional in it
# (file(GENERATE) touches a file only if it changes).
set(ts_generated "${PROJECT_BINARY_DIR}/opencv_ts")
foreach(header cvconfig.h cv_cpu_config.h opencv_tests_config.hpp)
  file(GENERATE OUTPUT "${ts_generated}/${header}" CONTENT "")
endforeach()
# Of the source's core those headers that are not installed: the source may be that of another version.
set(ts_include_directories "${ts_generated}" "${OPENCV_SOURCE_DIR}/modules/ts/include" ${OpenCV_INCLUDE_DIRS}
  "${OPENCV_SOURCE_DIR}/modules/core/include")
set(ts_libraries opencv_core opencv_imgproc opencv_imgcodecs opencv_videoio opencv_highgui Threads::Threads)
if(HDPSTEREO_TESTS_FROM)
  add_library(opencv_ts STATIC IMPORTED)
  set_target_properties(opencv_ts PROPERTIES IMPORTED_LOCATION "${HDPSTEREO_TESTS_FROM}/lib/libopencv_ts.a")
  target_include_directories(opencv_ts INTERFACE ${ts_include_directories})
  target_link_libraries(opencv_ts INTERFACE ${ts_libraries})
else()
  file(GLOB ts_sources "${OPENCV_SOURCE_DIR}/modules/ts/src/*.cpp")
  add_library(opencv_ts STATIC ${ts_sources})
  target_compile_definitions(opencv_ts PRIVATE __OPENCV_BUILD=1)
  target_include_directories(opencv_ts SYSTEM PUBLIC ${ts_include_directories})
  # It is not what is tested, and takes long.
  if(HDPSTEREO_SANITIZE)
    target_compile_options(opencv_ts PRIVATE -fno-sanitize=all)
  endif()
  if(NOT MSVC)
    target_compile_options(opencv_ts PRIVATE -O0)
  endif()
  target_link_libraries(opencv_ts PUBLIC ${ts_libraries})
endif()

# What a test program is compiled with. It is not what is tested: the optimizer, and sanitizers of the tests' own code,
# would take half of the time of a build. What it gives the library lies on the heap, which AddressSanitizer guards all the
# same. ThreadSanitizer has to see both sides of a lock.
function(use_opencv_ts target)
  target_link_libraries(${target} PRIVATE opencv_ts)
  target_compile_options(${target} PRIVATE ${warnings})
  if(NOT MSVC)
    target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O1>)
  endif()
  if(HDPSTEREO_SANITIZE AND NOT HDPSTEREO_SANITIZE MATCHES "thread")
    target_compile_options(${target} PRIVATE -fno-sanitize=all)
  endif()
  if(HDPSTEREO_SANITIZE MATCHES "address")
    target_compile_definitions(${target} PRIVATE HDPSTEREO_SANITIZE_ADDRESS)
  endif()
endfunction()
