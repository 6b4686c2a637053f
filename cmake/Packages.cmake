# Every outside library is found here, once.
include(InstalledPackages)
find_package(GTest REQUIRED)
include(GoogleTest)
find_package(CLI11 REQUIRED)
find_package(glm REQUIRED)
find_package(Boost 1.74 REQUIRED CONFIG)  # headers alone
pkg_check_modules(PROMETHEUS REQUIRED IMPORTED_TARGET prometheus-cpp-core)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
