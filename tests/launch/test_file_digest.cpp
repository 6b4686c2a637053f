#include "launch/run/file_digest.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "core/base/files/file_version.h"

namespace dmise {
namespace {

// SHA-256 of "abc" (FIPS 180-2, appendix B.1), and of "abd" by sha256sum of coreutils 9.1.
constexpr const char* of_abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr const char* of_abd = "a52d159f262b2c6ddb724a61840befc36eb30c88877a4030b65cbe86298449c9";

struct FileDigest : testing::Test {
  ~FileDigest() override { std::filesystem::remove(path_); }

  void write(const char* text) const { std::ofstream(path_) << text; }
  /// As of a file that was written a while ago.
  void let_settle() const {
    while (!file_version(path_)) std::this_thread::yield();
  }

  const std::string path_ = testing::TempDir() + "digest";
};

TEST_F(FileDigest, IsOfWhatTheFileHolds) {
  write("abc");
  let_settle();
  EXPECT_EQ(file_digest(path_), of_abc);
  EXPECT_EQ(file_digest(path_), of_abc);
  write("abd");
  EXPECT_EQ(file_digest(path_), of_abd);
  let_settle();
  EXPECT_EQ(file_digest(path_), of_abd);
}

TEST_F(FileDigest, OfAFileThatKeepsSizeAndTime) {
  write("abc");
  let_settle();
  const auto time = std::filesystem::last_write_time(path_);
  EXPECT_EQ(file_digest(path_), of_abc);
  write("abd");
  std::filesystem::last_write_time(path_, time);
  let_settle();
  EXPECT_EQ(file_digest(path_), of_abd);
}

// Two changes within a tick of the kernel have the same times.
TEST_F(FileDigest, OfAFileThatIsBeingWritten) {
  for (int i = 0; i < 50; ++i) {
    write(i % 2 ? "abc" : "abd");
    EXPECT_EQ(file_digest(path_), i % 2 ? of_abc : of_abd);
  }
}

}  // namespace
}  // namespace dmise
