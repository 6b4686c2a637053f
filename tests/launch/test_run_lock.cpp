#include "launch/run_lock.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

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

  /// A lock that nobody of this test holds, touched `age_s` ago.
  void leave(const std::string& text, double age_s) const {
    std::ofstream(file()) << text;
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    const timespec at{now.tv_sec - time_t(age_s), now.tv_nsec};
    const timespec both[2] = {at, at};
    utimensat(AT_FDCWD, file().c_str(), both, 0);
  }
  void leave(const LockHolder& holder, double age_s) const { leave(lock_text(holder), age_s); }

  /// Empty when the lock could be had.
  std::string refusal() const {
    try {
      RunLock lock(directory, RunLock::end_process, no_patience_s);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  }

  std::string directory;
};

/// A process that has ended, and its number when it ran.
LockHolder dead_process() {
  LockHolder holder = this_process();
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  holder.pid = child;
  return holder;
}

LockHolder on_another_host() {
  LockHolder holder = this_process();
  holder.host = "observatory-2";
  holder.machine = "11111111111111111111111111111111";
  holder.boot = "22222222-2222-2222-2222-222222222222";
  holder.command = "dmise run night.yaml";
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
    if (round % 3 == 1) leave(dead_process(), 0);
    if (round % 3 == 2) leave(on_another_host(), 3600);
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
          const RunLock lock(directory, RunLock::end_process, no_patience_s);
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

TEST_F(RunLocks, OfADeadProcessAreTakenOver) {
  leave(dead_process(), 0);
  EXPECT_EQ(refusal(), "");
}

TEST_F(RunLocks, OfAPidThatIsUsedAgainAreTakenOver) {
  LockHolder holder = this_process();
  ++holder.start;  // somebody of this number started at another time
  leave(holder, 0);
  EXPECT_EQ(refusal(), "");
}

TEST_F(RunLocks, OfALivingProcessStandAlsoWithoutLocksOfTheKernel) {
  leave(this_process(), 7200);
  EXPECT_THAT(refusal(), HasSubstr("pid " + std::to_string(getpid())));
}

TEST_F(RunLocks, OfAnotherHostStandAsLongAsItIsHeard) {
  leave(on_another_host(), lock_silent_s - 20);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("on observatory-2"), HasSubstr("dmise run night.yaml")));
  leave(on_another_host(), lock_silent_s + 20);
  EXPECT_EQ(refusal(), "");
}

TEST_F(RunLocks, FromBeforeAReboot) {
  const LockHolder self = this_process();
  LockHolder before = self;
  before.boot = "22222222-2222-2222-2222-222222222222";
  // 30 s ago, when this machine was not up yet.
  EXPECT_TRUE(has_ended(before, self, {.age_s = 30, .uptime_s = 20}));
  // A host of the same name, heard since this one is up.
  EXPECT_FALSE(has_ended(before, self, {.age_s = 30, .uptime_s = 40}));
  EXPECT_FALSE(has_ended(on_another_host(), self, {.age_s = 30, .uptime_s = 20}));
}

TEST_F(RunLocks, OfAnotherContainerAreTheKernels) {
  const LockHolder self = this_process();
  LockHolder other = self;
  other.pid_namespace = "pid:[4]";
  other.kernel_lock = true;
  using enum LockSight::KernelLock;
  EXPECT_FALSE(has_ended(other, self, {.age_s = 3600, .kernel_lock = held}));
  EXPECT_TRUE(has_ended(other, self, {.age_s = 1, .kernel_lock = free}));
  other.kernel_lock = false;
  EXPECT_FALSE(has_ended(other, self, {.age_s = 1, .kernel_lock = free}));
}

TEST_F(RunLocks, WhenTheClockOfTheFileSystemWasSetBack) {
  const LockHolder self = this_process();
  EXPECT_FALSE(has_ended(on_another_host(), self, {.age_s = -3600, .watched_s = 1}));
  EXPECT_TRUE(has_ended(on_another_host(), self, {.age_s = -3600, .watched_s = 2.1 * lock_beat_s}));
}

TEST_F(RunLocks, ThatSayNothingStandForAMinute) {
  const std::string whole = lock_text(this_process());
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2),
                                  std::string("{\"pid\":[1]}\n"), std::string(9000, 'x')}) {
    leave(text, 10);
    EXPECT_THAT(refusal(), HasSubstr("is in use"));
    leave(text, 3600);
    EXPECT_EQ(refusal(), "");
  }
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

TEST_F(RunLocks, TakenByForceAreLostAndSaidSo) {
  std::atomic<bool> lost = false;
  std::string said;
  const RunLock lock(directory, [&](const std::string& line) {
    said = line;
    lost = true;
  });
  std::filesystem::remove(file());
  leave(on_another_host(), 0);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!lost && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_THAT(said, HasSubstr("was taken by pid"));
  EXPECT_THAT(said, HasSubstr("observatory-2"));
}

TEST_F(RunLocks, AreTouchedByTheirHolder) {
  const RunLock lock(directory);
  leave(*RunLock::written_in(directory), 3600);
  struct stat seen {};
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  do {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ASSERT_EQ(stat(file().c_str(), &seen), 0);
  } while (seen.st_mtim.tv_sec < time(nullptr) - 60 && std::chrono::steady_clock::now() < deadline);
  EXPECT_GE(seen.st_mtim.tv_sec, time(nullptr) - 60);
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
  LockHolder holder = on_another_host();
  holder.command = "dmise run \"a\nb\"\xff";
  const auto back = parse_lock(lock_text(holder));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->host, holder.host);
  EXPECT_EQ(back->pid, holder.pid);
  EXPECT_EQ(back->start, holder.start);
  EXPECT_EQ(back->token, holder.token);
  EXPECT_THAT(describe(*back), HasSubstr("dmise run \"a?b\""));
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
