#pragma once
#include <cstdlib>
#include <fstream>
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

}  // namespace dmise
