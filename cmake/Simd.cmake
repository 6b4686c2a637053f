# Instruction sets of core/base/numeric/simd_sets.h: on x86 three, of which the machine chooses, elsewhere one.
set(DMISE_SIMD_SETS generic)
set(DMISE_SIMD_FLAGS_generic "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(DMISE_SIMD_SETS sse2 avx2 avx512)
  set(DMISE_SIMD_FLAGS_sse2 "")
  set(DMISE_SIMD_FLAGS_avx2 -mavx2)
  set(DMISE_SIMD_FLAGS_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mprefer-vector-width=512)
endif()

# dmise_simd_sources(TARGET a.cpp ...): compiles each file once per instruction set into TARGET. Such a
# file puts its functions into namespace dmise::DMISE_SIMD (core/base/numeric/lanes.h) and includes no header
# with functions that the linker could share between the sets.
function(dmise_simd_sources target)
  foreach(level ${DMISE_SIMD_SETS})
    add_library(${target}_${level} OBJECT ${ARGN})
    # GCC raises false alarms of uninitialized values in its own intrinsics headers.
    target_compile_options(${target}_${level} PRIVATE -O3 -fno-math-errno -fno-trapping-math -Wno-psabi
      "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-uninitialized>" ${DMISE_SIMD_FLAGS_${level}})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_${level}>)
  endforeach()
endfunction()
