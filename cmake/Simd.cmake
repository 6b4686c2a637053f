# dmise_simd_sources(TARGET a.cpp ...): compiles each file once per instruction set into TARGET. Such a
# file puts its functions into namespace dmise::DMISE_SIMD (core/base/lanes.h) and includes no header
# with functions that the linker could share between the three.
function(dmise_simd_sources target)
  set(flags_sse2 "")
  set(flags_avx2 -mavx2)
  set(flags_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mprefer-vector-width=512)
  foreach(level sse2 avx2 avx512)
    add_library(${target}_${level} OBJECT ${ARGN})
    # GCC raises false alarms of uninitialized values in its own intrinsics headers.
    target_compile_options(${target}_${level} PRIVATE -O3 -fno-math-errno -fno-trapping-math -Wno-psabi
      "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-uninitialized>" ${flags_${level}})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_${level}>)
  endforeach()
endfunction()
