# Every outside library is found here, once.
include(CorePackages)
find_package(Protobuf REQUIRED)
find_package(GTest REQUIRED)
include(GoogleTest)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(glm REQUIRED)
find_package(Boost 1.74 REQUIRED CONFIG)  # headers alone
pkg_check_modules(PROMETHEUS REQUIRED IMPORTED_TARGET prometheus-cpp-core)
pkg_check_modules(ZMQ REQUIRED IMPORTED_TARGET libzmq)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
