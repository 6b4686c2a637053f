# One source for each instruction set; which one runs is decided on the machine.
dmise_library(core_orbit_sgp4
  SOURCES
    sgp4_batch.cpp
    sgp4_groups.cpp
    sgp4_terms.cpp
    sgp4_deep_terms.cpp
    sgp4_kernel_sse2.cpp
    sgp4_kernel_avx2.cpp
    sgp4_kernel_avx512.cpp
    cone_test.cpp
    cone_test_sse2.cpp
    cone_test_avx2.cpp
    cone_test_avx512.cpp
  DEPENDS core_base)
# GCC 12 takes the unset inputs of its own intrinsics for mistakes of ours.
set(quiet "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>;-Wno-uninitialized")
set_source_files_properties(sgp4_kernel_sse2.cpp cone_test_sse2.cpp PROPERTIES COMPILE_OPTIONS "${quiet}")
set_source_files_properties(sgp4_kernel_avx2.cpp cone_test_avx2.cpp PROPERTIES
  COMPILE_OPTIONS "${quiet};-mavx2;-mfma")
set_source_files_properties(sgp4_kernel_avx512.cpp cone_test_avx512.cpp PROPERTIES
  COMPILE_OPTIONS "${quiet};-mavx512f;-mavx512dq;-mfma;-mprefer-vector-width=512")
