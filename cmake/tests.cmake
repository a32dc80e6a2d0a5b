# The suite, for CTest; CMakePresets.json has the builds to run it in. Labels:
#   unit, tools       one test for each test suite of opencv_test_hdpstereo and opencv_test_hdpstereo_tools
#   slow, threads     tests that are left out under AddressSanitizer, as they take long; those for ThreadSanitizer
#   instruction-sets  unit tests, and the maps to the bit, without the wider instruction sets; the objects for those
#   preload           programs under hdpstereo-run, and what it puts in the place of StereoSGBM
#   samples, python   programs of samples/ and of OpenCV's own samples; both Python modules
#   packages          projects that build with the module, in all of the ways that INSTALL.md names
#   performance       one round of the performance tests: that they run, not how fast
#   documentation     the reference and the tutorials, without a warning
# What cannot run for want of something is shown as skipped. The web page has tests of its own, scripts/check_web.sh, which
# first build OpenCV for WebAssembly.

file(GLOB test_sources CONFIGURE_DEPENDS test/test_*.cpp)
# These compile stages of the library once more, for vectors that OpenCV emulates: that is what is tested.
set(sources_with_stages test/test_range_scanlines.cpp test/test_scanline_aggregation.cpp test/test_sixteen_words.cpp
  test/test_volume_scanlines.cpp)
list(TRANSFORM sources_with_stages PREPEND "${PROJECT_SOURCE_DIR}/")
if(HDPSTEREO_SANITIZE MATCHES "address")
  set_source_files_properties(${sources_with_stages} PROPERTIES COMPILE_OPTIONS -fsanitize=address
    SKIP_PRECOMPILE_HEADERS ON)
endif()
# All others are not sanitized themselves, so those of another build will do.
set(other_test_sources "")
if(HDPSTEREO_TESTS_FROM)
  set(other_test_sources ${test_sources})
  set(test_sources "${PROJECT_SOURCE_DIR}/test/test_main.cpp" ${sources_with_stages})
  list(REMOVE_ITEM other_test_sources ${test_sources})
endif()
function(add_test_program kind)
  file(GLOB headers CONFIGURE_DEPENDS ${kind}/*.hpp)
  add_executable(opencv_${kind}_hdpstereo ${ARGN} ${headers})
  target_include_directories(opencv_${kind}_hdpstereo PRIVATE ${kind})
  target_link_libraries(opencv_${kind}_hdpstereo PRIVATE opencv_hdpstereo)
  use_opencv_ts(opencv_${kind}_hdpstereo)
endfunction()

add_test_program(test ${test_sources})
if(NOT HDPSTEREO_SANITIZE)
  file(GLOB perf_sources CONFIGURE_DEPENDS perf/*.cpp)
  add_test_program(perf ${perf_sources})
endif()
target_precompile_headers(opencv_test_hdpstereo PRIVATE test/test_precomp.hpp)
# Optional: a filter of ximgproc on our disparities. Inside OpenCV's build that test skips itself: there, a module's tests
# see what the module itself depends on.
if(TARGET opencv_ximgproc)
  target_link_libraries(opencv_test_hdpstereo PRIVATE opencv_ximgproc)
  target_compile_definitions(opencv_test_hdpstereo PRIVATE HDPSTEREO_TEST_XIMGPROC)
endif()

# Where programs find reference data and the Aloe pair; and no messages about bad input, which is tested a lot
set(samples_data "${OPENCV_SOURCE_DIR}/samples/data")
set(test_environment
  "OPENCV_TEST_DATA_PATH=${PROJECT_SOURCE_DIR}/testdata"
  "OPENCV_SAMPLES_DATA_PATH=${samples_data}"
  "OPENCV_LOG_LEVEL=FATAL")
if(HDPSTEREO_SANITIZE)
  list(APPEND test_environment
    # opencv_ts catches SIGSEGV, which would hide where it came from. Use after return, which doubles the time of some
    # suites, is left to the fuzzers. Up to GCC 13, __tls_get_addr() as intercepted takes some blocks of a thread's memory
    # for those of an old C library, and the search for leaks then crashes.
    "ASAN_OPTIONS=handle_segv=2:strict_string_checks=1:intercept_tls_get_addr=0"
    "UBSAN_OPTIONS=print_stacktrace=1"
    "TSAN_OPTIONS=halt_on_error=1")
endif()

# add_check(NAME LABELS COMMAND...): a test in this environment
function(add_check name labels)
  add_test(NAME ${name} COMMAND ${ARGN})
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" ENVIRONMENT "${test_environment}" TIMEOUT 3000
    SKIP_RETURN_CODE 77)
endfunction()

# As add_check(), if there is nothing missing; otherwise it is skipped, and says so.
function(add_optional_check name labels missing)
  if(missing)
    add_test(NAME ${name} COMMAND "${CMAKE_COMMAND}" -E echo "skipped: there is no ${missing}")
    set_tests_properties(${name} PROPERTIES LABELS "${labels}" SKIP_REGULAR_EXPRESSION "^skipped: ")
  else()
    add_check(${name} "${labels}" ${ARGN})
  endif()
endfunction()

# A run of a program of tests. It is skipped if it passes and one of its tests has skipped itself.
function(add_unit_tests name labels program filter)
  add_check(${name} "${labels}" ${program} "--gtest_filter=${filter}")
  set_tests_properties(${name} PROPERTIES
    FAIL_REGULAR_EXPRESSION "Running 0 tests"
    SKIP_REGULAR_EXPRESSION "\\[     SKIP \\].*\\[  PASSED  \\] [0-9]+ tests?\\.[\r\n ]*$")
endfunction()

# One test for each test suite in the sources of a program, with additions to the environment
function(add_suites program label environment)
  set(suites "")
  foreach(source IN LISTS ARGN)
    file(STRINGS "${source}" tests REGEX "^TEST(_P)?[(]")
    list(TRANSFORM tests REPLACE "^TEST(_P)?[(]([A-Za-z0-9_]+).*" "\\2")
    list(APPEND suites ${tests})
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  list(REMOVE_DUPLICATES suites)
  foreach(suite IN LISTS suites)
    set(labels ${label})
    if(suite MATCHES "_Slow")
      set(labels slow)
    elseif(suite MATCHES "_(RepetitivePattern|Adversarial|Preset|PresetsOnAloe|RigDepth|Threads)$")
      list(APPEND labels slow)
    endif()
    if(suite MATCHES "_(Threads|Endurance|MatcherContract)$")
      list(APPEND labels threads)
    endif()
    add_unit_tests(${suite} "${labels}" ${program} "${suite}.*:*/${suite}.*")
    set_property(TEST ${suite} APPEND PROPERTY ENVIRONMENT ${environment})
  endforeach()
endfunction()

add_suites(opencv_test_hdpstereo unit "" ${test_sources})
if(HDPSTEREO_TESTS_FROM)
  execute_process(COMMAND "${CMAKE_CXX_COMPILER}" -print-file-name=libasan.so
    OUTPUT_VARIABLE libasan OUTPUT_STRIP_TRAILING_WHITESPACE)
  add_suites("${HDPSTEREO_TESTS_FROM}/bin/opencv_test_hdpstereo" unit
    "LD_LIBRARY_PATH=${CMAKE_LIBRARY_OUTPUT_DIRECTORY};LD_PRELOAD=${libasan}" ${other_test_sources})
endif()
if(HDPSTEREO_TOOLS)
  if(HDPSTEREO_TESTS_FROM)
    add_suites("${HDPSTEREO_TESTS_FROM}/bin/opencv_test_hdpstereo_tools" tools
      "HDPSTEREO_PROGRAMS=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}" tools/test/test_programs.cpp tools/test/test_tiles.cpp tools/test/test_mgm.cpp)
  else()
    file(GLOB tools_test_sources CONFIGURE_DEPENDS tools/test/test_*.cpp)
    add_suites(opencv_test_hdpstereo_tools tools "" ${tools_test_sources})
  endif()
  # The longest ones under a sanitizer, and on one core for most of it: they begin first.
  set_tests_properties(HDPStereo_Programs HDPStereo_Tiles PROPERTIES COST 1)
endif()
if(HDPSTEREO_PRELOAD)
  file(GLOB preload_test_sources CONFIGURE_DEPENDS preload/test/test_*.cpp)
  add_suites(opencv_test_hdpstereo_preload preload "" ${preload_test_sources})
endif()

# Samples. These figures are checked elsewhere; this is the only place where the programs see a pair of full size.
set(aloe "${samples_data}/aloeL.jpg" "${samples_data}/aloeR.jpg" "--truth=${samples_data}/aloeGT.png" --num-disparities=256)
if(HDPSTEREO_SAMPLES)
  add_check(sample_stereo_match samples example_hdpstereo_hdp_stereo_match "${samples_data}/aloeL.jpg" "${samples_data}/aloeR.jpg"
    aloe.png --num-disparities=256)
  add_check(sample_own_tree samples example_hdpstereo_hdp_own_tree ${aloe})
  set(missing "")
  if(NOT TARGET example_hdpstereo_hdp_camera)
    set(missing "opencv_videoio")
  endif()
  add_optional_check(sample_camera samples "${missing}" example_hdpstereo_hdp_camera
    "${samples_data}/left%02d.jpg" "${samples_data}/right%02d.jpg" --frames=3 --no-gui --output=camera.avi)
endif()
if(HDPSTEREO_TOOLS)
  add_check(program_hdpstereo tools hdpstereo_program ${aloe} aloe_map.png --compare --picture=aloe_picture.png
    --point-cloud=aloe.ply --focal=1000 --baseline=1)
  if(TARGET hdp_benchmark)
    add_check(benchmark_small tools hdp_benchmark ${aloe} --resize=160x136 --num-disparities=32 --runs=2 --stages)
  endif()
endif()

if(HDPSTEREO_SANITIZE)
  return() # the rest is not built with sanitizers, or would test the same
endif()

add_check(includes unit "${PROJECT_SOURCE_DIR}/scripts/check_includes.sh")

# Once more without the instruction sets that this processor has: all that has an oracle, and the reference outputs
execute_process(COMMAND bash -c "source scripts/common.sh && printf '%s;' \"\${disabled_sets[@]:1}\""
  WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE disabled_sets)
list(REMOVE_ITEM disabled_sets "")
foreach(without IN LISTS disabled_sets)
  add_unit_tests(unit_without_${without} instruction-sets opencv_test_hdpstereo
    "HDPStereo_*Cost*:HDPStereo_*Aggregation*:HDPStereo_*Refinement*:*_DisparityConfidence*:*HDPStereo_ReferenceOutput*")
  set_property(TEST unit_without_${without} APPEND PROPERTY ENVIRONMENT "OPENCV_CPU_DISABLE=${without}")
endforeach()
add_check(maps_of_instruction_sets instruction-sets "${PROJECT_SOURCE_DIR}/scripts/check_instruction_sets.sh"
  $<TARGET_FILE:opencv_test_hdpstereo> "${CMAKE_BINARY_DIR}/maps")

set(missing "")
if(NOT dispatched_modes)
  set(missing "instruction set but the baseline")
endif()
add_optional_check(dispatched_objects instruction-sets "${missing}"
  "${PROJECT_SOURCE_DIR}/scripts/check_dispatch_objects.sh" "${CMAKE_BINARY_DIR}")

add_check(performance_tests performance opencv_perf_hdpstereo
  "--gtest_param_filter=*640x480*" --perf_min_samples=1 --perf_force_samples=1)
set_tests_properties(performance_tests PROPERTIES FAIL_REGULAR_EXPRESSION "Running 0 tests")

set(missing "")
if(NOT HDPSTEREO_PYTHON_PACKAGE)
  set(missing "HDPSTEREO_PYTHON_PACKAGE in this build")
endif()
add_optional_check(python_package python "${missing}"
  "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/python/test/test_hdpstereo.py" --verbose)
add_optional_check(sample_dask "samples;python" "${missing}"
  "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/python/test/test_hdp_dask.py")
add_optional_check(sample_rasterio "samples;python" "${missing}"
  "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/python/test/test_hdp_rasterio.py")
if(NOT missing)
  set_property(TEST python_package sample_dask sample_rasterio APPEND PROPERTY ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
endif()

set(missing "")
if(NOT HDPSTEREO_PYTHON)
  set(missing "HDPSTEREO_PYTHON in this build")
else()
  find_package(Python3 COMPONENTS Interpreter)
endif()
add_optional_check(python python "${missing}"
  "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/misc/python/test/test_hdpstereo.py" --verbose)
add_optional_check(sample_stereo_match_python "samples;python" "${missing}"
  "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/samples/hdp_stereo_match.py" ${aloe} --compare --runs=1
  --output=aloe_python.pfm --picture=aloe_python.jpg)
add_optional_check(sample_stereo_match_python_alone "samples;python" "${missing}"
  "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/samples/hdp_stereo_match.py" --runs=1)
add_optional_check(drop_in "samples;python" "${missing}"
  "${PROJECT_SOURCE_DIR}/scripts/check_drop_in.sh" "${CMAKE_BINARY_DIR}" "${OPENCV_SOURCE_DIR}" "${Python3_EXECUTABLE}")
if(NOT missing)
  set_property(TEST python sample_stereo_match_python sample_stereo_match_python_alone drop_in APPEND PROPERTY ENVIRONMENT
    "PYTHONPATH=${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/python3")
  set_tests_properties(python PROPERTIES SKIP_REGULAR_EXPRESSION "OK \\(skipped=")
endif()

add_check(other_projects packages "${PROJECT_SOURCE_DIR}/scripts/check_other_projects.sh" "${CMAKE_BINARY_DIR}")

set(missing "")
if(NOT HDPSTEREO_PRELOAD)
  set(missing "HDPSTEREO_PRELOAD in this build")
endif()
foreach(programs cpp python gstreamer)
  add_optional_check(run_${programs} preload "${missing}" "${PROJECT_SOURCE_DIR}/scripts/check_run.sh" "${CMAKE_BINARY_DIR}"
    "${OPENCV_SOURCE_DIR}" ${programs})
endforeach()

set(missing "")
find_program(DOXYGEN doxygen)
find_program(BIBTEX bibtex)
if(NOT DOXYGEN OR NOT BIBTEX)
  set(missing "doxygen or bibtex")
endif()
add_optional_check(documentation documentation "${missing}" "${PROJECT_SOURCE_DIR}/scripts/docs.sh")
