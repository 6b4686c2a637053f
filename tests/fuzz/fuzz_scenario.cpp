#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "core/config/scenario.h"

using namespace dmise;

// A scenario is read whole or refused by a ConfigError of one line: never a crash, and nothing but
// finite numbers within what is read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/tmp/dmise-fuzz-scenario-" + std::to_string(getpid()) + ".yaml";
  static const int at_exit = std::atexit([] { std::remove(path.c_str()); });
  if (at_exit != 0) std::abort();
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), long(size));
  try {
    physics_json(load_scenario(path));  // refuses what is not finite
  } catch (const ConfigError& e) {
    for (const char* c = e.what(); *c; ++c)
      if (static_cast<unsigned char>(*c) < 0x20 || *c == 0x7f) std::abort();
  }
  return 0;
}
