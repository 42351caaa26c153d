# Two ways to make a target, so that every folder's list reads the same and every file gets the same flags.

add_library(sunfleck_flags INTERFACE)
target_compile_options(sunfleck_flags INTERFACE
  -Wall -Wextra -Wpedantic -Werror -Wshadow -Wfloat-conversion -Wnon-virtual-dtor
  # Guards against NaN and infinity stay: no -ffast-math. These two remove only errno and traps.
  -fno-math-errno -fno-trapping-math)
target_include_directories(sunfleck_flags INTERFACE ${CMAKE_SOURCE_DIR})
if(SUNFLECK_SANITIZE)
  # GCC 12 warns of uninitialised use inside the standard library's own headers once sanitizers reshape them.
  target_compile_options(sunfleck_flags INTERFACE -fsanitize=${SUNFLECK_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all -Wno-maybe-uninitialized)
  target_link_options(sunfleck_flags INTERFACE -fsanitize=${SUNFLECK_SANITIZE})
endif()
find_program(SUNFLECK_CCACHE ccache)
if(SUNFLECK_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SUNFLECK_CCACHE})
endif()

# sunfleck_library(name SOURCES a.cpp ... LINKS public_target ... PRIVATE_LINKS target ...)
function(sunfleck_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(${name} STATIC ${arg_SOURCES})
  target_link_libraries(${name} PUBLIC ${arg_LINKS} PRIVATE sunfleck_flags ${arg_PRIVATE_LINKS})
  target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
endfunction()

# sunfleck_test(name SOURCES a_test.cpp ... LINKS target ...): one GoogleTest program, run by ctest as one test. Those of
# tests/support/slow_tests.txt are labelled slow: the presets debug and tsan leave them out.
file(STRINGS ${CMAKE_SOURCE_DIR}/tests/support/slow_tests.txt SUNFLECK_SLOW_TESTS REGEX "^[a-z]")
list(TRANSFORM SUNFLECK_SLOW_TESTS REPLACE " .*" "")
set(SUNFLECK_TEST_LIMIT_S 900)
if(SUNFLECK_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(SUNFLECK_TEST_LIMIT_S 3600)
endif()
function(sunfleck_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE sunfleck_flags test_support ${arg_LINKS} GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE SUNFLECK_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${SUNFLECK_TEST_LIMIT_S}
    ENVIRONMENT "TSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/support/tsan_suppressions.txt")
  if(name IN_LIST SUNFLECK_SLOW_TESTS)
    set_tests_properties(${name} PROPERTIES LABELS slow)
  endif()
endfunction()

# sunfleck_bench(name SOURCES a_bench.cpp ... LINKS target ...): one Google Benchmark program, never a test.
function(sunfleck_bench name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  if(SUNFLECK_BENCH)
    add_executable(${name} ${arg_SOURCES})
    target_link_libraries(${name} PRIVATE sunfleck_flags ${arg_LINKS} benchmark::benchmark_main)
    target_compile_definitions(${name} PRIVATE SUNFLECK_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  endif()
endfunction()
