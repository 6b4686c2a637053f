add_executable(fuzz_fits ${CMAKE_CURRENT_LIST_DIR}/fuzz_fits.cpp)
target_link_libraries(fuzz_fits PRIVATE core_image)
target_link_options(fuzz_fits PRIVATE -fsanitize=fuzzer)
