dmise_test(test_sgp4
  SOURCES test_sgp4_verification.cpp
  DEPENDS core_orbit_sgp4)
