#include "core/base/files/user_directories.h"

#include <cstdlib>

namespace dmise {

namespace {

std::string user_directory(const char* variable, const char* below_home) {
  if (const char* xdg = std::getenv(variable); xdg && *xdg) return std::string(xdg) + "/dmise";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::string(home) + "/" + below_home + "/dmise";
  return "";
}

}  // namespace

std::string cache_directory() { return user_directory("XDG_CACHE_HOME", ".cache"); }

std::string data_directory() { return user_directory("XDG_DATA_HOME", ".local/share"); }

std::string config_directory() { return user_directory("XDG_CONFIG_HOME", ".config"); }

}  // namespace dmise
