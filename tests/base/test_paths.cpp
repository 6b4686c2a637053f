#include "core/base/files/paths.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(Paths, MakesDirectoriesAndSaysWhyItCannot) {
  const std::string top = testing::TempDir() + "/paths";
  EXPECT_FALSE(path_exists(top));
  make_directories(top + "/a/b");
  make_directories(top + "/a/b");
  EXPECT_TRUE(path_exists(top + "/a/b"));
  const std::string file = top + "/file", below = file + "/c";
  std::ofstream(file) << "x";
  try {
    make_directories(below, "--out");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_EQ(e.what(), "--out: " + below + ": can't be made: Not a directory");
  }
  try {
    make_directories(below);
    FAIL();
  } catch (const ConfigError&) {
    FAIL() << "the user did not name it";
  } catch (const Error& e) {
    EXPECT_EQ(e.what(), below + ": can't be made: Not a directory");
  }
  std::filesystem::remove_all(top);
}

}  // namespace
}  // namespace dmise
