# The fuzzers, and a minute of each as a test. Inputs that were new are kept in the corpus for the next time.

enable_testing()
set(asan_options
  "ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:detect_leaks=1:intercept_tls_get_addr=0")
foreach(name compute calibration)
  add_executable(hdpstereo_fuzz_${name} fuzz/fuzz_${name}.cpp)
  target_link_libraries(hdpstereo_fuzz_${name} PRIVATE opencv_hdpstereo)
  target_compile_options(hdpstereo_fuzz_${name} PRIVATE ${warnings})
  target_link_options(hdpstereo_fuzz_${name} PRIVATE -fsanitize=fuzzer)

  file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/corpus/${name}")
  add_test(NAME fuzz_${name} COMMAND hdpstereo_fuzz_${name} -max_total_time=60 -timeout=120 -rss_limit_mb=4096 -max_len=512
    -len_control=0 -print_final_stats=1 "-artifact_prefix=${CMAKE_BINARY_DIR}/found-${name}-"
    "${CMAKE_BINARY_DIR}/corpus/${name}")
  set_tests_properties(fuzz_${name} PROPERTIES LABELS fuzz
    ENVIRONMENT "${asan_options};UBSAN_OPTIONS=print_stacktrace=1")
endforeach()
