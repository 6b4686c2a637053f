#include "core/base/cache_directory.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace dmise {
namespace {

/// Sets both variables for one test; null: unset.
class Environment {
 public:
  Environment(const char* xdg, const char* home) {
    set("XDG_CACHE_HOME", xdg);
    set("HOME", home);
  }
  ~Environment() {
    set("XDG_CACHE_HOME", xdg_.empty() ? nullptr : xdg_.c_str());
    set("HOME", home_.empty() ? nullptr : home_.c_str());
  }

 private:
  static std::string value_of(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
  }
  static void set(const char* name, const char* value) {
    if (value)
      setenv(name, value, 1);
    else
      unsetenv(name);
  }
  std::string xdg_ = value_of("XDG_CACHE_HOME"), home_ = value_of("HOME");
};

// The XDG Base Directory Specification 0.8: ~/.cache where the variable is not set or empty.
TEST(CacheDirectory, IsThatOfTheDesktopOrOfTheHome) {
  {
    const Environment both("/var/cache/me", "/home/me");
    EXPECT_EQ(cache_directory(), "/var/cache/me/dmise");
  }
  for (const char* none : {static_cast<const char*>(nullptr), ""}) {
    const Environment home_alone(none, "/home/me");
    EXPECT_EQ(cache_directory(), "/home/me/.cache/dmise");
  }
  for (const char* none : {static_cast<const char*>(nullptr), ""}) {
    const Environment neither(none, none);
    EXPECT_EQ(cache_directory(), "");
  }
}

}  // namespace
}  // namespace dmise
