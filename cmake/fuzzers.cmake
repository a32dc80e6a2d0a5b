# The fuzzers, and a minute of each as a test. Inputs that were new are kept in the corpus for the next time.

add_executable(hdpstereo_fuzz_compute fuzz/fuzz_compute.cpp)
target_link_libraries(hdpstereo_fuzz_compute PRIVATE opencv_hdpstereo)
target_compile_options(hdpstereo_fuzz_compute PRIVATE ${warnings})
target_link_options(hdpstereo_fuzz_compute PRIVATE -fsanitize=fuzzer)

enable_testing()
file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/corpus")
add_test(NAME fuzz_compute COMMAND hdpstereo_fuzz_compute -max_total_time=60 -timeout=120 -rss_limit_mb=4096 -max_len=512
  -len_control=0 -print_final_stats=1 "-artifact_prefix=${CMAKE_BINARY_DIR}/found-" "${CMAKE_BINARY_DIR}/corpus")
set_tests_properties(fuzz_compute PROPERTIES LABELS fuzz ENVIRONMENT
  "ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:detect_leaks=1;UBSAN_OPTIONS=print_stacktrace=1")
