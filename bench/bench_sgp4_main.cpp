#include <cstdio>
#include <cstring>
#include <exception>

#include "bench/bench_sgp4.h"

int main(int argc, char** argv) try {
  return dmise::bench_sgp4(argc > 1 && std::strcmp(argv[1], "--json") == 0);
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench-sgp4: %s\n", e.what());
  return 1;
}
