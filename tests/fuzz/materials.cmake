dmise_fuzz(fuzz_obj SOURCES fuzz_obj.cpp DEPENDS core_materials)
dmise_fuzz(fuzz_mtl SOURCES fuzz_mtl.cpp DEPENDS core_materials)
