#include "nodes/runtime/process/spawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "nodes/runtime/process/process_stat.h"

namespace dmise {
namespace {

using testing::HasSubstr;

/// Runs a shell's commands to their end; the shell looks at what it was given.
class SpawnTest : public testing::Test {
 public:
  ~SpawnTest() override { std::filesystem::remove_all(directory_); }

 protected:
  SpawnTest() { std::filesystem::create_directories(directory_); }

  int exit_code_of(const std::string& commands, bool keep_log = false) {
    const pid_t pid = spawn({.name = "shell",
                             .arguments = {"/bin/sh", "-c", commands},
                             .log_path = log_,
                             .keep_log = keep_log,
                             .directory = directory_,
                             .environment = {"DMISE_TOLD=a b"}});
    int status = 0;
    EXPECT_EQ(waitpid(pid, &status, 0), pid);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string log() const { return read_text_file(log_); }

  const std::string directory_ =
      (std::filesystem::path(testing::TempDir()) / "dmise-spawn").string();
  const std::string log_ = directory_ + "/log";
};

TEST_F(SpawnTest, RunsInItsDirectoryWithItsEnvironmentAndLog) {
  EXPECT_EQ(exit_code_of("pwd -P; echo \"$DMISE_TOLD\"; echo wrong >&2; cat; exit 7"), 7);
  EXPECT_EQ(log(), std::filesystem::canonical(directory_).string() + "\na b\nwrong\n");
}

TEST_F(SpawnTest, KeepsALogIfItIsTold) {
  EXPECT_EQ(exit_code_of("echo first"), 0);
  EXPECT_EQ(exit_code_of("echo second", true), 0);
  EXPECT_EQ(log(), "first\nsecond\n");
  EXPECT_EQ(exit_code_of("echo third"), 0);
  EXPECT_EQ(log(), "third\n");
}

TEST_F(SpawnTest, SaysWhyAProgramCannotBeStarted) {
  for (const std::string& program : {directory_ + "/nothing", directory_}) try {
      spawn({.name = "gnc", .arguments = {program}, .log_path = log_});
      FAIL() << program;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(program + ": can't be started: "));
    }
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);  // nothing is left of them
}

TEST_F(SpawnTest, AGroupOfItsOwnEndsWithWhatItHasStarted) {
  const pid_t pid = spawn({.name = "shell",
                           .arguments = {"/bin/sh", "-c", "sleep 100 & echo $!; wait"},
                           .log_path = log_,
                           .own_group = true});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!log().ends_with('\n') && std::chrono::steady_clock::now() < deadline) usleep(1000);
  ASSERT_TRUE(log().ends_with('\n'));
  EXPECT_EQ(getpgid(pid), pid);
  EXPECT_EQ(getpgid(std::stoi(log())), pid);
  kill(-pid, SIGKILL);
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(ProcessState, IsThatOfTheProcess) {
  const pid_t pid = spawn({.name = "sleep", .arguments = {"/bin/sleep", "60"}});
  ASSERT_EQ(kill(pid, SIGSTOP), 0);
  ASSERT_EQ(waitpid(pid, nullptr, WUNTRACED), pid);
  EXPECT_EQ(process_state(pid), 'T');
  ASSERT_EQ(kill(pid, SIGKILL), 0);
  siginfo_t ended{};
  ASSERT_EQ(waitid(P_PID, id_t(pid), &ended, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(process_state(pid), 'Z');
  ASSERT_EQ(waitpid(pid, nullptr, 0), pid);
  EXPECT_EQ(process_state(pid), '?');
  EXPECT_EQ(process_state(getpid()), 'R');
}

}  // namespace
}  // namespace dmise
