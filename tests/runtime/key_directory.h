#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "nodes/runtime/security/keys.h"

namespace dmise::test {

/// A directory of keys that goes away again.
struct Keys {
  explicit Keys(const std::vector<std::string>& names, const std::vector<std::string>& truth = {}) {
    std::string path = testing::TempDir() + "dmise-keys-XXXXXX";
    directory = mkdtemp(path.data());
    for (const auto& name : names) make_key(directory, name, false);
    for (const auto& name : truth) make_key(directory, name, true);
  }
  ~Keys() { std::filesystem::remove_all(directory); }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  std::string directory;
};

}  // namespace dmise::test
