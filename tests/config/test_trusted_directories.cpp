#include "core/config/yaml/trusted_directories.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/files/whole_file.h"
#include "tests/support/config_error.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

class TrustedDirectories : public testing::Test {
 public:
  ~TrustedDirectories() override { fs::remove_all(top_); }

 protected:
  TrustedDirectories() {
    for (const fs::path& directory : {top_, list_.parent_path(), top_ / "a/b", top_ / "ab"}) {
      fs::create_directories(directory);
      allow(directory, 0755);
    }
    allow(top_ / "a", 0755);
  }

  static void allow(const fs::path& path, unsigned mode) { fs::permissions(path, fs::perms(mode)); }
  void list(const std::string& text) const {
    write_file_whole(list_.string(), text);
    allow(list_, 0644);
  }
  std::string distrust(const fs::path& directory) const {
    return why_not_trusted(directory.string(), list_.string());
  }

  const fs::path top_ = fs::canonical(testing::TempDir()) / "trusted";
  const fs::path list_ = top_ / "config/trusted-directories";
};

TEST_F(TrustedDirectories, AreThoseOfTheListAndBelow) {
  EXPECT_EQ(distrust(top_ / "a"),
            "no line of " + list_.string() + " is " + top_.string() + "/a or above it");
  list("# mine\n\n  " + (top_ / "a").string() + "/ \r\n/no/such\n");
  EXPECT_EQ(distrust(top_ / "a"), "");
  EXPECT_EQ(distrust(top_ / "a/b/."), "");
  EXPECT_EQ(distrust(top_ / "a/b/../../a"), "");
  EXPECT_THAT(distrust(top_ / "ab"), EndsWith("/ab or above it"));
  EXPECT_THAT(distrust(top_), HasSubstr("no line of "));
  EXPECT_THAT(distrust(top_ / "none"), HasSubstr("no line of "));
}

TEST_F(TrustedDirectories, ALinkIsTheDirectoryThatItLeadsTo) {
  list((top_ / "a").string());
  fs::create_directory_symlink(top_ / "ab", top_ / "a/link");
  EXPECT_THAT(distrust(top_ / "a/link"), EndsWith("/ab or above it"));
  fs::create_directory_symlink(top_ / "a/b", top_ / "to_b");
  EXPECT_EQ(distrust(top_ / "to_b"), "");
}

TEST_F(TrustedDirectories, NobodyElseMayWriteToThem) {
  list((top_ / "a").string());
  for (const fs::path& path : {top_ / "a", top_ / "a/b", list_, list_.parent_path()})
    for (const unsigned mode : {0775u, 0757u, 0777u}) {
      allow(path, mode);
      EXPECT_EQ(distrust(top_ / "a/b"), list_.string() +
                                            ":1: does not count: others may write to " +
                                            path.string() + " (chmod go-w)");
      allow(path, 0755);
    }
  EXPECT_EQ(distrust(top_ / "a/b"), "");
}

TEST_F(TrustedDirectories, BelongToTheUser) {
  list("/");
  const bool root = geteuid() == 0;
  if (root && chown((top_ / "a/b").c_str(), 65534, 65534) != 0) GTEST_SKIP() << "may not chown";
  EXPECT_THAT(root ? distrust(top_ / "a/b") : distrust("/usr"), EndsWith(" is not yours"));
}

TEST_F(TrustedDirectories, AreAbsolutePaths) {
  list("\n~/a\n");
  EXPECT_EQ(test::config_error_of([&] { distrust(top_); }),
            list_.string() + ":2: must be an absolute path, got ~/a");
}

}  // namespace
}  // namespace dmise
