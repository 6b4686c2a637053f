dmise_library(bench_render SOURCES bench_render.cpp DEPENDS bench_figure core_optics render)
