#include "core/base/cache_directory.h"

#include <cstdlib>

namespace dmise {

std::string cache_directory() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
    return std::string(xdg) + "/dmise";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::string(home) + "/.cache/dmise";
  return "";
}

}  // namespace dmise
