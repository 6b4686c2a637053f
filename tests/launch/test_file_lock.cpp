#include "launch/process/file_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

#include "core/base/error.h"

namespace dmise {
namespace {

struct FileLocks : testing::Test {
  FileLocks() {
    std::string path = testing::TempDir() + "dmise-lock-XXXXXX";
    directory = mkdtemp(path.data());
    file = directory + "/below/name.lock";
  }
  ~FileLocks() override { std::filesystem::remove_all(directory); }
  std::string directory, file;
};

TEST_F(FileLocks, OneHasItAtATime) {
  std::optional<FileLock> first(file);
  FileLock second(file);
  EXPECT_TRUE(first->take());
  EXPECT_FALSE(second.take());
  first.reset();
  EXPECT_TRUE(second.take());
}

TEST_F(FileLocks, OfBytesAreHeldAloneOrShared) {
  using enum FileLock::Use;
  std::optional<FileLock> first(file);
  FileLock second(file);
  EXPECT_TRUE(first->take(0, alone));
  EXPECT_TRUE(second.take(1, alone));
  EXPECT_FALSE(second.take(0, shared));
  EXPECT_TRUE(first->take(0, shared));
  EXPECT_TRUE(second.take(0, shared));
  EXPECT_FALSE(first->take(0, alone));
  EXPECT_FALSE(first->take());
  second.release(0);
  EXPECT_TRUE(first->take(0, alone));
  first.reset();
  EXPECT_TRUE(second.take());
}

TEST_F(FileLocks, EndWithTheirProcessAndPassToTheProgramThatItBecomes) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    FileLock lock(file);
    const char taken = lock.take() ? 'y' : 'n';
    if (write(pipe_ends[1], &taken, 1) != 1) _exit(1);
    execlp("sleep", "sleep", "600", nullptr);
    _exit(1);
  }
  char taken = ' ';
  ASSERT_EQ(read(pipe_ends[0], &taken, 1), 1);
  EXPECT_EQ(taken, 'y');
  FileLock lock(file);
  EXPECT_FALSE(lock.take());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(lock.take());
}

TEST_F(FileLocks, NeedAFileThatCanBeMade) {
  EXPECT_THROW(FileLock("/proc/nothing/name.lock"), Error);
}

}  // namespace
}  // namespace dmise
