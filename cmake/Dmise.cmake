# The verbs of the build: dmise_library, dmise_program, dmise_module, dmise_test.
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
set(DMISE_TEST_OBJECTS "" CACHE PATH "tree whose compiled tests are linked to the libraries of this one")
option(DMISE_WERROR "treat warnings as errors" ON)
option(DMISE_UNITY "compile the sources of a folder together, a dozen at a time" OFF)
option(DMISE_PRECOMPILE "read the headers of the standard library, CLI11 and GoogleTest once for many sources" ON)

# Trees with sanitizers are compiled once and for all.
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
  add_link_options(-fsanitize=${DMISE_SANITIZE} -fuse-ld=lld)
endif()
include_directories(${CMAKE_SOURCE_DIR})

# For what compiles longer than it runs: tests, commands, readers of files, and nodes but for what they compute.
set(DMISE_QUICK_TO_COMPILE "$<$<CONFIG:Release>:-O1>")

# Precompiled headers: each list is read once for all targets whose directory names it in DMISE_PRECOMPILED.
set(DMISE_PRECOMPILED precompiled)
if(DMISE_PRECOMPILE)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp CONTENT "int main() {}\n")
  set(DMISE_OFTEN <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <numeric>
            <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <utility> <variant> <vector>)
  add_library(precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_precompile_headers(precompiled PRIVATE ${DMISE_OFTEN})
  if(NOT DMISE_SANITIZE)  # where few programs are built
    add_library(precompiled_quick OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    target_compile_options(precompiled_quick PRIVATE ${DMISE_QUICK_TO_COMPILE})
    target_precompile_headers(precompiled_quick PRIVATE ${DMISE_OFTEN})
    add_library(precompiled_commands OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    target_compile_options(precompiled_commands PRIVATE ${DMISE_QUICK_TO_COMPILE})
    target_precompile_headers(precompiled_commands PRIVATE ${DMISE_OFTEN} <CLI/CLI.hpp>)
  endif()
  add_executable(precompiled_tests EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(precompiled_tests PRIVATE GTest::gtest GTest::gmock)
  target_compile_options(precompiled_tests PRIVATE ${DMISE_QUICK_TO_COMPILE})
  target_precompile_headers(precompiled_tests PRIVATE ${DMISE_OFTEN} <gmock/gmock.h> <gtest/gtest.h>)
endif()

# precompile(TARGET WITH): at the end of its directory, where options of single sources, which are left out, are known.
function(precompile target with)
  if(DMISE_SANITIZE AND with MATCHES "_nodes|_quick")
    set(with precompiled)
  endif()
  if(TARGET ${with})
    cmake_language(EVAL CODE "cmake_language(DEFER CALL precompile_now ${target} ${with})")
  endif()
endfunction()
function(precompile_now target with)
  target_precompile_headers(${target} REUSE_FROM ${with})
  # GCC forgets that precompiled headers are the system's, whose false alarms it does not report.
  set(false_alarms array-bounds dangling-pointer maybe-uninitialized restrict stringop-overflow stringop-overread use-after-free)
  list(TRANSFORM false_alarms PREPEND -Wno-)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:${false_alarms}>)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()

# compile_together(TARGET): several sources as one, where DMISE_UNITY says so. Sources with options of their own stay alone.
function(compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${DMISE_UNITY} UNITY_BUILD_BATCH_SIZE 12)
  if(DMISE_UNITY)
    # GCC takes sources that another includes for headers, whose types may not have unnamed namespaces in them.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# dmise_library(NAME SOURCES a.cpp ... [DEPENDS lib ...]): an interface library when it has no source. A directory whose
# DMISE_PRECOMPILED is precompiled_quick or one that builds on it compiles quickly, for what it does is not what takes time.
function(dmise_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC ${ARG_DEPENDS})
    compile_together(${name})
    if(NOT DMISE_PRECOMPILED STREQUAL "precompiled")
      target_compile_options(${name} PRIVATE ${DMISE_QUICK_TO_COMPILE})
    endif()
    precompile(${name} ${DMISE_PRECOMPILED})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ARG_DEPENDS})
  endif()
  if(name MATCHES "^core_")
    install_library(${name})
  endif()
endfunction()

# install_library(NAME): for other projects, as dmise::NAME.
function(install_library name)
  get_target_property(type ${name} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    target_include_directories(${name} INTERFACE $<INSTALL_INTERFACE:include/dmise>)
  else()
    target_include_directories(${name} PUBLIC $<INSTALL_INTERFACE:include/dmise>)
  endif()
  install(TARGETS ${name} EXPORT dmise ARCHIVE DESTINATION lib/dmise COMPONENT development)
endfunction()

# dmise_program(NAME [ASIDE] SOURCES main.cpp ... [DEPENDS lib ...]): is quick to compile, for what runs long is in libraries.
# Target `programs` builds all programs and modules but those ASIDE.
add_custom_target(programs)
add_custom_target(demo_programs)  # those that the demonstration needs
function(dmise_program name)
  cmake_parse_arguments(ARG "ASIDE" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS})
  compile_together(${name})
  # Code of libraries and of programs reads the same precompiled headers.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${name} PRIVATE -fPIC ${DMISE_QUICK_TO_COMPILE})
  precompile(${name} precompiled_commands)
  if(ARG_ASIDE)
    return()
  endif()
  add_dependencies(programs ${name})
  if(name MATCHES "^dmise")
    install(TARGETS ${name} RUNTIME DESTINATION bin COMPONENT runtime)
    set_property(GLOBAL APPEND PROPERTY DMISE_PROGRAMS ${name})
  endif()
endfunction()

# dmise_module(NAME SOURCES a.cpp ... [DEPENDS lib ...]): a shared object that programs load when they need it.
function(dmise_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS})
  compile_together(${name})
  precompile(${name} ${DMISE_PRECOMPILED})
  target_link_options(${name} PRIVATE -Wl,--exclude-libs,ALL)
  if(NOT DMISE_SANITIZE)  # what sanitizers call is in the program
    target_link_options(${name} PRIVATE -Wl,--no-undefined)
  endif()
  add_dependencies(programs ${name})
  install(TARGETS ${name} LIBRARY DESTINATION lib/dmise COMPONENT runtime)
endfunction()

# Tests that compute run at idle priority beside those that have deadlines or measure, of which one runs at a time.
set(DMISE_COMPUTING chrt --idle 0)
file(STRINGS ${CMAKE_SOURCE_DIR}/tests/sanitizers/thread.txt DMISE_TIMED_TESTS)  # threads and sockets have deadlines

# dmise_test(NAME SOURCES test_a.cpp ... [DEPENDS lib ...] [LONG Suite.Test ..]): a GoogleTest program, each TEST a ctest. Those that
# are LONG, by GoogleTest's patterns, have the label `all`: they run with `./dmise test --all`. Target
# `unit_tests` builds them all, and unit-tests.txt in the build directory names them.
add_custom_target(unit_tests)
function(dmise_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LONG" ${ARGN})
  if(DMISE_UNITY)
    join_sources(ARG_SOURCES ${name} ${ARG_SOURCES})
  endif()
  if(DMISE_TEST_OBJECTS)
    compiled_elsewhere(ARG_SOURCES ${name} ${ARG_SOURCES})
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} test_main GTest::gtest GTest::gmock)
  add_dependencies(unit_tests ${name})
  set_property(GLOBAL APPEND PROPERTY DMISE_TESTS ${name})
  if(DMISE_TEST_OBJECTS)
    set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
    return()
  endif()
  target_compile_definitions(${name} PRIVATE
    DMISE_SOURCE_DIR="${CMAKE_SOURCE_DIR}" DMISE_BINARY_DIR="${CMAKE_BINARY_DIR}")
  target_compile_options(${name} PRIVATE ${DMISE_QUICK_TO_COMPILE})
  precompile(${name} precompiled_tests)
  if(NOT CMAKE_CROSSCOMPILING AND NOT name IN_LIST DMISE_TIMED_TESTS)
    set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR "${DMISE_COMPUTING}")
  endif()
  list(JOIN ARG_LONG ":" long)
  gtest_discover_tests(${name} TEST_FILTER "-${long}" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 300 PROPERTIES TIMEOUT 2400)
  if(long)
    gtest_discover_tests(${name} TEST_FILTER "${long}" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 300
                         PROPERTIES TIMEOUT 2400 LABELS all)
  endif()
endfunction()

# join_sources(VARIABLE TARGET a.cpp ..): the few sources that hold all these, eight in each. What is no test stays alone, as do
# sources with options and those that SKIP_UNITY_BUILD_INCLUSION.
function(join_sources variable target)
  set(joined "")
  foreach(source ${ARGN})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    get_source_file_property(alone ${source} SKIP_UNITY_BUILD_INCLUSION)
    if(options OR alone OR NOT source MATCHES "^test_")
      list(APPEND joined ${source})
    else()
      get_filename_component(source ${source} ABSOLUTE)
      list(APPEND together ${source})
    endif()
  endforeach()
  set(number 0)
  while(together)
    list(SUBLIST together 0 8 some)
    list(REMOVE_ITEM together ${some})
    set(file ${CMAKE_CURRENT_BINARY_DIR}/${target}_${number}.cpp)
    add_custom_command(OUTPUT ${file} COMMAND awk -f ${CMAKE_SOURCE_DIR}/cmake/concatenate.awk ${some} > ${file}
                       DEPENDS ${some} ${CMAKE_SOURCE_DIR}/cmake/concatenate.awk COMMENT "Joining sources of ${target}" VERBATIM)
    list(APPEND joined ${file})
    math(EXPR number "${number} + 1")
  endwhile()
  set(${variable} ${joined} PARENT_SCOPE)
endfunction()

# compiled_elsewhere(VARIABLE TARGET a.cpp ..): what these sources of the target are in DMISE_TEST_OBJECTS.
function(compiled_elsewhere variable target)
  file(RELATIVE_PATH here ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  list(TRANSFORM ARGN REPLACE "${CMAKE_CURRENT_BINARY_DIR}/" "")
  list(TRANSFORM ARGN REPLACE "\\.\\./" "__/")
  list(TRANSFORM ARGN PREPEND "${DMISE_TEST_OBJECTS}/${here}/CMakeFiles/${target}.dir/")
  list(TRANSFORM ARGN APPEND ".o")
  set_source_files_properties(${ARGN} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set(${variable} ${ARGN} PARENT_SCOPE)
endfunction()
