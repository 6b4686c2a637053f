#include "launch/process/run_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace dmise {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double no_patience_s = 0.0;

struct RunLocks : testing::Test {
  RunLocks() {
    std::string path = testing::TempDir() + "dmise-lock-XXXXXX";
    directory = mkdtemp(path.data());
  }
  ~RunLocks() override { std::filesystem::remove_all(directory); }

  std::string file() const { return directory + "/.run-lock"; }

  /// A lock file that nobody holds.
  void leave(const std::string& text) const { std::ofstream(file()) << text; }

  /// Empty when the lock could be had.
  std::string refusal() const {
    try {
      RunLock lock(directory, no_patience_s);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  }

  std::string directory;
};

/// The number of a process that has ended.
LockHolder dead_process() {
  LockHolder holder = this_process();
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  holder.pid = child;
  return holder;
}

TEST_F(RunLocks, NameTheirHolderAndEndWithIt) {
  {
    const RunLock lock(directory);
    EXPECT_THAT(
        refusal(),
        AllOf(HasSubstr(directory + ": is in use by pid " + std::to_string(getpid())),
              HasSubstr(this_process().host), HasSubstr(" since 20"), HasSubstr("test_joining")));
  }
  EXPECT_FALSE(std::filesystem::exists(file()));
  EXPECT_EQ(refusal(), "");
  EXPECT_TRUE(std::filesystem::is_empty(directory));
}

TEST_F(RunLocks, OneOfManyThatStartAtOnceHasIt) {
  constexpr int processes = 8, rounds = 40;
  for (int round = 0; round < rounds; ++round) {
    // Every third time a dead process has left its lock: one of them takes it over.
    if (round % 3 == 1) leave(lock_text(dead_process()));
    int start[2], result[2], end[2];
    ASSERT_TRUE(pipe(start) == 0 && pipe(result) == 0 && pipe(end) == 0);
    for (int i = 0; i < processes; ++i)
      if (fork() == 0) {
        char byte = '?';
        close(start[1]);
        close(end[1]);
        if (read(start[0], &byte, 1) != 0) _exit(1);  // the start is the end of the pipe
        byte = 'n';
        try {
          const RunLock lock(directory, no_patience_s);
          byte = 'y';
          if (write(result[1], &byte, 1) != 1 || read(end[0], &byte, 1) != 0) _exit(1);
          _exit(0);  // as one that dies: the file stays
        } catch (const ConfigError&) {
        }
        _exit(write(result[1], &byte, 1) == 1 ? 0 : 1);
      }
    close(start[1]);
    int holders = 0;
    for (int i = 0; i < processes; ++i) {
      char byte = '?';
      ASSERT_EQ(read(result[0], &byte, 1), 1);
      holders += byte == 'y';
    }
    EXPECT_EQ(holders, 1) << "round " << round;
    close(end[1]);
    for (int i = 0; i < processes; ++i) {
      int status = 0;
      wait(&status);
      EXPECT_EQ(status, 0);
    }
    for (const int fd : {start[0], result[0], result[1], end[0]}) close(fd);
    std::filesystem::remove(file());
  }
}

TEST_F(RunLocks, ThatNobodyHoldsAreTakenOverWhateverTheySay) {
  const std::string whole = lock_text(this_process());
  for (const std::string& text :
       {lock_text(dead_process()), whole, std::string(), whole.substr(0, whole.size() / 2),
        std::string("{\"pid\":[1]}\n"), std::string(9000, 'x')}) {
    leave(text);
    EXPECT_EQ(refusal(), "");
  }
}

// As while its holder has not yet written its name.
TEST_F(RunLocks, WithoutAHolderStand) {
  const RunLock lock(directory);
  std::filesystem::resize_file(file(), 0);
  EXPECT_THAT(refusal(), HasSubstr("is in use by a run that has just begun"));
}

TEST_F(RunLocks, StandUntilTheLastProcessOfADeadRunHasEnded) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t launcher = fork();
  if (launcher == 0) {
    const RunLock lock(directory);
    const pid_t node = fork();
    if (node == 0) execlp("sleep", "sleep", "600", nullptr);
    if (write(ready[1], &node, sizeof node) < 0) _exit(1);
    pause();
  }
  pid_t node = 0;
  ASSERT_EQ(read(ready[0], &node, sizeof node), ssize_t(sizeof node));
  kill(launcher, SIGKILL);
  waitpid(launcher, nullptr, 0);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("left by"), HasSubstr(std::to_string(launcher))));
  kill(node, SIGKILL);
  const RunLock lock(directory);  // waits for the node's end
}

TEST_F(RunLocks, PassToTheProgramThatTheirProcessBecomes) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    RunLock lock(directory);
    lock.release_to_exec();
    if (write(ready[1], "y", 1) != 1) _exit(1);
    execlp("sleep", "sleep", "600", nullptr);
    _exit(1);
  }
  char taken = ' ';
  ASSERT_EQ(read(ready[0], &taken, 1), 1);
  EXPECT_THAT(refusal(), HasSubstr("is in use by pid " + std::to_string(child)));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(refusal(), "");
}

// Somebody has planted it: what it names is not written into.
TEST_F(RunLocks, DoNotFollowLinks) {
  const std::string other = directory + "/other", nothing = directory + "/nothing";
  std::ofstream(other) << "untouched";
  for (const std::string& target : {other, nothing}) {
    std::filesystem::create_symlink(target, file());
    EXPECT_EQ(refusal(), "");
  }
  ASSERT_EQ(mkfifo(file().c_str(), 0600), 0);
  EXPECT_EQ(refusal(), "");
  std::filesystem::create_hard_link(other, file());
  EXPECT_THROW(RunLock(directory, no_patience_s), Error);
  EXPECT_EQ(std::filesystem::file_size(other), 9u);
  EXPECT_FALSE(std::filesystem::exists(nothing));
}

TEST_F(RunLocks, TellWhichRunTheyAreOf) {
  RunLock lock(directory);
  EXPECT_EQ(RunLock::written_in(directory)->run_id, 0u);
  lock.set_run_id(0x0123456789abcdef);
  EXPECT_EQ(RunLock::written_in(directory)->run_id, 0x0123456789abcdefu);
}

TEST_F(RunLocks, NeedADirectoryThatCanBeWritten) {
  EXPECT_THROW(RunLock("/proc"), Error);
  EXPECT_THROW(lock_directory("/proc/nothing"), Error);
}

TEST(LockHolders, ReadBackWhatTheyWriteAndAnythingElseIsNone) {
  LockHolder holder = this_process();
  holder.command = "dmise run \"a\nb\"\xff";
  const auto back = parse_lock(lock_text(holder));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->host, holder.host);
  EXPECT_EQ(back->pid, holder.pid);
  EXPECT_EQ(back->since_utc, holder.since_utc);
  EXPECT_THAT(describe(*back), HasSubstr("dmise run \"a\\nb\""));
  const std::string whole = lock_text(holder);
  for (std::size_t n = 0; n + 2 < whole.size(); ++n) EXPECT_FALSE(parse_lock(whole.substr(0, n)));
  // Each byte changed to each of some others: read or refused, never an end.
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char byte : {'"', '0', '-', '{', '\0', '\xff'}) {
      std::string changed = whole;
      changed[i] = byte;
      parse_lock(changed);
    }
}

}  // namespace
}  // namespace dmise
