dmise_library(bench_sgp4 SOURCES bench_sgp4.cpp sgp4_scale.cpp DEPENDS core_orbit core_orbit_sgp4)
target_compile_definitions(bench_sgp4 PRIVATE DMISE_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
dmise_program(bench-sgp4 SOURCES bench_sgp4_main.cpp DEPENDS bench_sgp4)
