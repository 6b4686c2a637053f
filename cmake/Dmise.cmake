# The three verbs of the build: dmise_library, dmise_program, dmise_test.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g")

set(CMAKE_EXPORT_COMPILE_COMMANDS ON)  # for clang-tidy

set(DMISE_SANITIZE "" CACHE STRING "sanitizers to build with, as for -fsanitize=")
option(DMISE_FUZZ "build the libFuzzer targets (clang)" OFF)
option(DMISE_WERROR "treat warnings as errors" ON)
option(DMISE_PRECOMPILE "read the standard library and GoogleTest once for all tests, with sanitizers for all sources" ON)

# Trees with sanitizers are compiled once and for all; a cache keeps less with precompiled headers than without.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER AND NOT DMISE_SANITIZE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# No contracted multiply-adds and no fast-math: products must not depend on what a compiler fuses.
add_compile_options(-ffp-contract=off -Wall -Wextra -Wno-missing-field-initializers)
if(DMISE_WERROR)
  add_compile_options(-Werror)
endif()
if(DMISE_SANITIZE)
  add_compile_options(-fsanitize=${DMISE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${DMISE_SANITIZE})
endif()
if(DMISE_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
include_directories(${CMAKE_SOURCE_DIR})

if(DMISE_PRECOMPILE)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp CONTENT "int main() {}\n")
  set(often <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <numeric>
            <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <utility> <variant> <vector>)
  if(DMISE_SANITIZE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    add_library(precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    target_precompile_headers(precompiled PRIVATE ${often})
  endif()
  add_executable(precompiled_tests EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(precompiled_tests PRIVATE GTest::gtest GTest::gmock)
  target_precompile_headers(precompiled_tests PRIVATE ${often} <gmock/gmock.h> <gtest/gtest.h>)
endif()

# precompile(TARGET WITH): at the end of its directory, where options of single sources, which are left out, are known.
function(precompile target with)
  if(TARGET ${with})
    cmake_language(EVAL CODE "cmake_language(DEFER CALL precompile_now ${target} ${with})")
  endif()
endfunction()
function(precompile_now target with)
  target_precompile_headers(${target} REUSE_FROM ${with})
  # GCC forgets that precompiled headers are the system's, whose false alarms it does not report.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-maybe-uninitialized;-Wno-restrict;-Wno-stringop-overflow>)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()

# dmise_library(NAME SOURCES a.cpp ... [DEPENDS lib ...]): an interface library when it has no source.
function(dmise_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC ${ARG_DEPENDS})
    precompile(${name} precompiled)
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ARG_DEPENDS})
  endif()
endfunction()

# dmise_program(NAME SOURCES main.cpp ... [DEPENDS lib ...]): target `programs` builds them all.
add_custom_target(programs)
function(dmise_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS})
  add_dependencies(programs ${name})
endfunction()

# dmise_test(NAME SOURCES test_a.cpp ... [DEPENDS lib ...]): a GoogleTest program, each TEST a ctest.
function(dmise_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    DMISE_SOURCE_DIR="${CMAKE_SOURCE_DIR}" DMISE_BINARY_DIR="${CMAKE_BINARY_DIR}")
  precompile(${name} precompiled_tests)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()
