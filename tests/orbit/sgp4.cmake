dmise_test(test_sgp4
  SOURCES test_sgp4_verification.cpp test_sgp4_hard_cases.cpp test_sgp4_order.cpp
          test_sgp4_batch.cpp test_sgp4_heap.cpp test_cone_test.cpp
  DEPENDS core_orbit_sgp4)
