dmise_library(core_wcs SOURCES ${CMAKE_CURRENT_LIST_DIR}/wcs.cpp DEPENDS core_base)
