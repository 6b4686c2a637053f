# Light of meshes: above core_materials, which is above core_photometry.
dmise_library(core_facets
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/facet_set.cpp ${CMAKE_CURRENT_LIST_DIR}/facet_texture.cpp ${CMAKE_CURRENT_LIST_DIR}/facet_clip.cpp
          ${CMAKE_CURRENT_LIST_DIR}/facet_shadow.cpp ${CMAKE_CURRENT_LIST_DIR}/facet_light.cpp
          ${CMAKE_CURRENT_LIST_DIR}/earthshine.cpp
  DEPENDS core_materials)
dmise_simd_sources(core_facets ${CMAKE_CURRENT_LIST_DIR}/facet_kernels.cpp)
