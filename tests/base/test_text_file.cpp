#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/base/files/regular_file.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

class TextFile : public testing::Test {
 protected:
  fs::path directory = fs::path(testing::TempDir()) / "text-file";
  void SetUp() override { fs::create_directories(directory); }
  void TearDown() override { fs::remove_all(directory); }
  std::string path(const char* name) const { return (directory / name).string(); }
};

TEST_F(TextFile, ReadsWhatWasWrittenAndLeavesNothingElse) {
  const std::string content("one\0two\n", 8);
  write_file_whole(path("a"), content);
  EXPECT_EQ(read_text_file(path("a")), content);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory), {}), 1);
}

TEST_F(TextFile, IsWrittenInThePlaceOfALinkWhoseTargetStays) {
  write_file_whole(path("target"), "theirs");
  for (const char* name : {"a", "a.partial"}) fs::create_symlink(path("target"), path(name));
  write_file_whole(path("a"), "ours");
  EXPECT_EQ(read_text_file(path("target")), "theirs");
  EXPECT_EQ(read_text_file(path("a")), "ours");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path("a"))));
}

TEST_F(TextFile, IsNeverWrittenInThePlaceOfADevice) {
  const std::string device = path("device");
  if (mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) GTEST_SKIP() << "needs root";
  EXPECT_EQ(open_own_file(device.c_str(), O_WRONLY | O_TRUNC), -1);
  EXPECT_TRUE(fs::is_character_file(fs::symlink_status(device)));
}

TEST_F(TextFile, OfTheProgramItselfIsNoLinkNorFifo) {
  write_file_whole(path("target"), "theirs");
  fs::create_symlink(path("target"), path("link"));
  fs::create_hard_link(path("target"), path("name"));
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  for (const char* name : {"link", "name", "fifo", "new"}) {
    const int file = open_own_file(path(name).c_str(), O_WRONLY | O_APPEND | O_TRUNC);
    ASSERT_GE(file, 0) << name;
    EXPECT_EQ(write(file, "ours", 4), 4);
    close(file);
    EXPECT_EQ(read_text_file(path(name)), "ours");
  }
  EXPECT_EQ(read_text_file(path("target")), "theirs");
  const int more = open_own_file(path("new").c_str(), O_WRONLY | O_APPEND);
  EXPECT_EQ(write(more, " too", 4), 4);
  close(more);
  EXPECT_EQ(read_text_file(path("new")), "ours too");
  EXPECT_LT(open_own_file(directory.c_str(), O_WRONLY), 0);
}

TEST_F(TextFile, ReadsGzip) {
  gzFile file = gzopen(path("a.gz").c_str(), "wb");
  gzputs(file, "packed\n");
  gzclose(file);
  EXPECT_EQ(read_text_file(path("a.gz")), "packed\n");
}

TEST_F(TextFile, RefusesGzipThatIsCutOff) {
  gzFile file = gzopen(path("a.gz").c_str(), "wb");
  for (int i = 0; i < 100'000; ++i) gzprintf(file, "%d\n", i);
  gzclose(file);
  const auto whole = fs::file_size(path("a.gz"));
  for (const auto size : {whole - 1, whole / 2, std::uintmax_t(5)}) {
    fs::resize_file(path("a.gz"), size);
    try {
      read_text_file(path("a.gz"));
      FAIL() << size;
    } catch (const ConfigError& e) {
      EXPECT_EQ(e.what(), path("a.gz") + ": is cut off: its gzip data do not end");
    }
  }
}

TEST_F(TextFile, NamesTheFileThatItCannotRead) {
  try {
    read_text_file(path("none"));
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_EQ(e.what(), path("none") + ": No such file or directory");
  }
  EXPECT_THROW(read_text_file(directory.string()), ConfigError);
  write_file_whole(path("big"), std::string(100, 'x'));
  EXPECT_THROW(read_text_file(path("big"), 99), ConfigError);
}

// A FIFO has no writer here: opening it must not wait for one. /dev/zero has no end.
TEST_F(TextFile, RefusesWhatIsNoRegularFile) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  const auto refusal = [](const std::string& of) {
    try {
      read_text_file(of, 1000);
    } catch (const ConfigError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(path("fifo")), path("fifo") + ": is a FIFO, not a regular file");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is a device, not a regular file");
  EXPECT_EQ(refusal("/dev/null"), "/dev/null: is a device, not a regular file");
  EXPECT_EQ(refusal("/proc/self/status"),
            "/proc/self/status: is a virtual file of the kernel, not a regular file");
  EXPECT_EQ(refusal("/sys/kernel/uevent_seqnum"),
            "/sys/kernel/uevent_seqnum: is a virtual file of the kernel, not a regular file");
  fs::create_symlink(path("fifo"), path("link"));
  EXPECT_EQ(refusal(path("link")), path("link") + ": is a FIFO, not a regular file");
}

TEST_F(TextFile, LeavesTheOldFileWhenTheNewOneCannotBeWritten) {
  write_file_whole(path("a"), "old");
  fs::create_directory(path("a.partial"));  // stands in the way
  EXPECT_THROW(write_file_whole(path("a"), "new"), Error);
  EXPECT_EQ(read_text_file(path("a")), "old");
}

TEST_F(TextFile, WhatIsWrittenIsTheEndOfLinksAndNoFifoDeviceOrDirectory) {
  const auto refusal = [](const std::string& to) -> std::string {
    try {
      file_to_write("--out", to);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(file_to_write("--out", path("new")), path("new"));
  fs::create_directory(directory / "there");
  fs::create_symlink("there/file", directory / "relative");
  fs::create_symlink("relative", directory / "twice");
  EXPECT_EQ(file_to_write("--out", path("twice")), path("there/file"));
  fs::create_symlink("/dev/null", directory / "device");
  mkfifo(path("fifo").c_str(), 0600);
  fs::create_symlink("loop", directory / "loop");
  EXPECT_EQ(refusal(path("device")),
            "--out: is a device, not a regular file, got " + path("device"));
  EXPECT_EQ(refusal(path("fifo")), "--out: is a FIFO, not a regular file, got " + path("fifo"));
  EXPECT_EQ(refusal(path("there")), "--out: is a directory, got " + path("there"));
  EXPECT_NE(refusal(path("loop")), "");
  EXPECT_NE(refusal("/proc/self/comm"), "");
}

}  // namespace
}  // namespace dmise
