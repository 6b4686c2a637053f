#include "core/base/files/user_directories.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace dmise {
namespace {

/// Sets both variables for one test; null: unset.
class Environment {
 public:
  Environment(const char* variable, const char* xdg, const char* home)
      : variable_(variable), xdg_(value_of(variable)) {
    set(variable, xdg);
    set("HOME", home);
  }
  ~Environment() {
    set(variable_, xdg_.empty() ? nullptr : xdg_.c_str());
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
  const char* variable_;
  std::string xdg_, home_ = value_of("HOME");
};

// The XDG Base Directory Specification 0.8: ~/.cache, ~/.local/share and ~/.config where the
// variable is not set or empty.
TEST(UserDirectories, AreThoseOfTheDesktopOrOfTheHome) {
  const struct {
    const char* variable;
    std::string (*directory)();
    const char* of_home;
  } cases[] = {{"XDG_CACHE_HOME", cache_directory, "/home/me/.cache/dmise"},
               {"XDG_DATA_HOME", data_directory, "/home/me/.local/share/dmise"},
               {"XDG_CONFIG_HOME", config_directory, "/home/me/.config/dmise"}};
  for (const auto& [variable, directory, of_home] : cases) {
    {
      const Environment both(variable, "/var/me", "/home/me");
      EXPECT_EQ(directory(), "/var/me/dmise");
    }
    for (const char* none : {static_cast<const char*>(nullptr), ""}) {
      const Environment home_alone(variable, none, "/home/me");
      EXPECT_EQ(directory(), of_home);
    }
    for (const char* none : {static_cast<const char*>(nullptr), ""}) {
      const Environment neither(variable, none, none);
      EXPECT_EQ(directory(), "");
    }
  }
}

}  // namespace
}  // namespace dmise
