#include "core/base/files/file_version.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

namespace dmise {
namespace {

struct FileVersions : testing::Test {
  ~FileVersions() override { std::filesystem::remove(path_); }

  void write(const char* text) const { std::ofstream(path_) << text; }
  /// The version of a file that was written a while ago.
  std::optional<FileVersion> settled() const {
    while (!file_version(path_)) std::this_thread::yield();
    return file_version(path_);
  }

  const std::string path_ = testing::TempDir() + "version";
};

TEST_F(FileVersions, AreEqualUntilTheFileChanges) {
  write("one");
  const auto first = settled();
  EXPECT_EQ(settled(), first);
  write("two");
  EXPECT_NE(settled(), first);
}

TEST_F(FileVersions, TellAFileThatTookThePlaceOfAnother) {
  write("one");
  const auto first = settled();
  const auto time = std::filesystem::last_write_time(path_);
  std::ofstream(path_ + ".new") << "two";
  std::filesystem::last_write_time(path_ + ".new", time);
  std::filesystem::rename(path_ + ".new", path_);
  EXPECT_NE(settled(), first);
}

// Once at least, for this process may pause after a write.
TEST_F(FileVersions, AreNoneOfAFileThatWasJustWritten) {
  bool none = false;
  for (int i = 0; i < 100 && !none; ++i) {
    write("one");
    none = !file_version(path_);
  }
  EXPECT_TRUE(none);
}

TEST_F(FileVersions, AreNoneOfWhatIsNoRegularFile) {
  EXPECT_FALSE(file_version(testing::TempDir()));
  EXPECT_FALSE(file_version("/dev/zero"));
  EXPECT_FALSE(file_version(path_ + ".none"));
}

}  // namespace
}  // namespace dmise
