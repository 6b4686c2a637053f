#pragma once
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace dmise {

/// Returns a line of /proc/self/status [MB], 0 if there is none; `key`: "VmHWM", "VmRSS", ...
inline double status_mb(const std::string& key) {
  std::ifstream file("/proc/self/status");
  std::string line;
  while (std::getline(file, line))
    if (line.starts_with(key + ":"))
      return std::strtod(line.c_str() + key.size() + 1, nullptr) / 1e3;
  return 0.0;
}

/// Gives the pages of code back that this process has used: the kernel maps them again as they are
/// used, so that a peak after this has only what runs after this.
inline void forget_code() {
  std::ifstream maps("/proc/self/maps");
  std::string line;
  while (std::getline(maps, line)) {
    std::istringstream fields(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::string rights;
    if (fields >> std::hex >> begin >> dash >> end >> rights && rights == "r-xp" &&
        line.find(" /") != line.npos)
      ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
  }
}

}  // namespace dmise
