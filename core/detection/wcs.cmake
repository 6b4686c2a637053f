dmise_library(core_wcs SOURCES ${CMAKE_CURRENT_LIST_DIR}/wcs.cpp ${CMAKE_CURRENT_LIST_DIR}/wcs_refraction.cpp DEPENDS core_base core_places core_projection)
