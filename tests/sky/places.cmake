dmise_test(test_places
  SOURCES test_apparent_satellites.cpp test_apparent_stars.cpp test_occultation.cpp
          test_refraction.cpp test_shadow.cpp test_sun_moon.cpp
  DEPENDS core_places)
