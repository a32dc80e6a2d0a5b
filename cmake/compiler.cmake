# ${warnings}, and the options of HDPSTEREO_SANITIZE for all targets.

if(HDPSTEREO_BUILD_FUZZERS)
  set(HDPSTEREO_SANITIZE fuzzer-no-link,address,undefined,float-cast-overflow)
endif()
if(HDPSTEREO_SANITIZE)
  # _DEBUG turns on the range checks of cv::Mat::at and its like, _GLIBCXX_ASSERTIONS those of std::vector.
  add_compile_options(-fsanitize=${HDPSTEREO_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_compile_definitions(_DEBUG _GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=${HDPSTEREO_SANITIZE})
endif()

# The x87 of 32-bit x86 rounds as it likes.
if(CMAKE_SIZEOF_VOID_P EQUAL 4 AND CMAKE_SYSTEM_PROCESSOR MATCHES "86|AMD64" AND NOT MSVC)
  add_compile_options(-msse2 -mfpmath=sse)
endif()

# The warnings that OpenCV's own build turns on
if(MSVC)
  set(warnings /W4)
else()
  set(warnings -Wall -Wextra -Wreturn-type -Wnon-virtual-dtor -Waddress -Wsequence-point -Wformat -Wformat-security
      -Wmissing-declarations -Wundef -Winit-self -Wpointer-arith -Wshadow -Wsign-promo -Wuninitialized
      -Wno-delete-non-virtual-dtor -Wno-comment -Wno-strict-overflow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND warnings -Wsuggest-override -Wimplicit-fallthrough=3 -Wno-psabi)
  else()
    list(APPEND warnings -Winconsistent-missing-override)
  endif()
  if(HDPSTEREO_WARNINGS_AS_ERRORS)
    list(APPEND warnings -Werror)
  endif()
endif()
