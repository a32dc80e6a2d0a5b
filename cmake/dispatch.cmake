# Dispatch as OpenCV's build does it, by the installed opencv2/core/cv_cpu_*.h and what that build would generate. The
# CPU decides which instruction set runs (OPENCV_CPU_DISABLE="AVX512-ICL,AVX512-SKX" in the environment leaves some out).
# Only the files of dispatched stages are compiled with __OPENCV_BUILD, which turns those headers on.
#
# To add a stage: its name in dispatched_stages, and
# - src/NAME.simd.hpp, without include guard: in namespace cv::stereo::hdp, between CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN and
#   CV_CPU_OPTIMIZATION_NAMESPACE_END, declarations of the functions to be dispatched, then their definitions under
#   #ifndef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY; what it includes must not define functions that are not inlined;
# - src/NAME.cpp: includes NAME.simd.hpp (that is the baseline) and NAME.simd_declarations.hpp (generated, the others),
#   and calls a function by CV_CPU_DISPATCH(function, (arguments), CV_CPU_DISPATCH_MODES_ALL), which returns its result.

set(SSE4_2_flags -msse4.2 -mpopcnt)
set(SSE4_2_features SSE3 SSSE3 SSE4_1 POPCNT SSE4_2)
set(AVX2_flags -mavx2 -mfma -mf16c -mpopcnt)
set(AVX2_features ${SSE4_2_features} AVX FP16 FMA3 AVX2)
set(AVX512_SKX_flags ${AVX2_flags} -mavx512f -mavx512cd -mavx512bw -mavx512dq -mavx512vl)
set(AVX512_SKX_features ${AVX2_features} AVX_512F AVX512_COMMON AVX512_SKX)
set(AVX512_ICL_flags ${AVX512_SKX_flags} -mavx512ifma -mavx512vbmi -mavx512vbmi2 -mavx512bitalg -mavx512vnni
    -mavx512vpopcntdq)
set(AVX512_ICL_features ${AVX512_SKX_features} AVX512_ICL)
set(dispatched_options)
if(HDPSTEREO_BUILD_FUZZERS)
  # The coverage of loops over pixels tells a fuzzer nothing, and would take nearly all of its time.
  set(dispatched_options -O2 -fno-sanitize=fuzzer-no-link)
endif()
# The baseline is what the compiler has without an option, as far as the stages have something for it.
set(cpu_config
"#if defined __SSE2__ || defined _M_X64
#define CV_CPU_COMPILE_SSE 1
#define CV_CPU_BASELINE_COMPILE_SSE 1
#define CV_CPU_COMPILE_SSE2 1
#define CV_CPU_BASELINE_COMPILE_SSE2 1
#elif defined __ARM_NEON || defined _M_ARM64
#define CV_CPU_COMPILE_NEON 1
#define CV_CPU_BASELINE_COMPILE_NEON 1
#endif
")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|amd64|AMD64)$" AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" AND NOT MSVC)
  foreach(mode IN LISTS dispatched_modes)
    string(APPEND cpu_config "#define CV_CPU_DISPATCH_COMPILE_${mode} 1\n")
  endforeach()
else()
  set(dispatched_modes) # the baseline alone
endif()

# What is compiled for one mode: a library of objects, whose files share a precompiled header.
function(add_objects_of_mode target mode sources definitions options)
  set(objects ${target}_${mode})
  add_library(${objects} OBJECT ${sources})
  foreach(property COMPILE_DEFINITIONS COMPILE_OPTIONS INCLUDE_DIRECTORIES LINK_LIBRARIES)
    set_property(TARGET ${objects} PROPERTY ${property} $<TARGET_PROPERTY:${target},${property}>)
  endforeach()
  target_compile_definitions(${objects} PRIVATE __OPENCV_BUILD=1 ${definitions}
    $<$<STREQUAL:$<TARGET_PROPERTY:${target},TYPE>,SHARED_LIBRARY>:CVAPI_EXPORTS>)
  target_compile_options(${objects} PRIVATE ${options})
  target_precompile_headers(${objects} PRIVATE src/precomp.hpp <opencv2/core/hal/intrin.hpp>)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
endfunction()

# The stages of a target for the baseline and for each of dispatched_modes
function(add_dispatched_stages target)
  set(dispatch_generated "${PROJECT_BINARY_DIR}/dispatch")
  file(GENERATE OUTPUT "${dispatch_generated}/cvconfig.h" CONTENT "#define CV_ENABLE_INTRINSICS\n")
  file(GENERATE OUTPUT "${dispatch_generated}/cv_cpu_config.h" CONTENT "${cpu_config}")
  add_objects_of_mode(${target} BASELINE "${dispatched_sources}" "" "")
  set(all_modes BASELINE)
  foreach(mode IN LISTS dispatched_modes)
    set(definitions CV_CPU_DISPATCH_MODE=${mode})
    foreach(feature IN LISTS ${mode}_features)
      list(APPEND definitions CV_CPU_COMPILE_${feature}=1)
    endforeach()
    set(sources "")
    foreach(stage IN LISTS dispatched_stages)
      list(APPEND sources "${dispatch_generated}/${stage}.${mode}.cpp")
      file(GENERATE OUTPUT "${dispatch_generated}/${stage}.${mode}.cpp"
        CONTENT "#include \"precomp.hpp\"\n#include \"${stage}.simd.hpp\"\n")
    endforeach()
    set_source_files_properties(${sources} PROPERTIES GENERATED TRUE)
    add_objects_of_mode(${target} ${mode} "${sources}" "${definitions}" "${${mode}_flags};${dispatched_options}")
    set(all_modes "${mode}, ${all_modes}")
  endforeach()
  foreach(stage IN LISTS dispatched_stages)
    set(declarations "")
    foreach(mode IN LISTS dispatched_modes)
      string(APPEND declarations
"#undef CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
#undef CV_CPU_OPTIMIZATION_NAMESPACE_END
#define CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN namespace opt_${mode} {
#define CV_CPU_OPTIMIZATION_NAMESPACE_END }
#include \"${stage}.simd.hpp\"
")
    endforeach()
    file(GENERATE OUTPUT "${dispatch_generated}/${stage}.simd_declarations.hpp" CONTENT
"#undef CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#define CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
${declarations}#define CV_CPU_DISPATCH_MODES_ALL ${all_modes}
")
  endforeach()
  target_include_directories(${target} PRIVATE "${dispatch_generated}")
endfunction()
