#pragma once
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

extern char** environ;

// Child processes for tests: everything is waited for with a deadline, nothing sleeps, nothing is
// left running.
namespace dmise::test {

class Child {
 public:
  explicit Child(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
    std::vector<char*> argv;
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    if (posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ) != 0) pid_ = -1;
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_fd_ = ends[0];
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ > 0 && !code_) {
      kill(SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    if (output_fd_ >= 0) close(output_fd_);
  }

  void kill(int signal) { ::kill(pid_, signal); }

  /// Everything written to stdout and stderr so far.
  const std::string& output() const { return output_; }

  /// False when `text` was not written within the time.
  bool says(const std::string& text, double within_s = 60.0) {
    const auto deadline = after(within_s);
    while (output_.find(text) == std::string::npos)
      if (!read_some(deadline)) return false;
    return true;
  }

  /// The exit code (128 + signal when killed), or nothing when it still runs after the time.
  std::optional<int> exit_code(double within_s = 60.0) {
    if (code_) return code_;
    const auto deadline = after(within_s);
    while (read_some(deadline)) {  // until it closes its output
    }
    const int pidfd = int(syscall(SYS_pidfd_open, pid_, 0));
    pollfd ended{pidfd, POLLIN, 0};
    const int ready = poll(&ended, 1, left_ms(deadline));
    close(pidfd);
    if (ready != 1) return std::nullopt;
    int status = 0;
    waitpid(pid_, &status, 0);
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return code_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static Clock::time_point after(double s) {
    return Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  }
  static int left_ms(Clock::time_point deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    return int(std::max<std::int64_t>(left.count(), 0));
  }
  bool read_some(Clock::time_point deadline) {
    pollfd readable{output_fd_, POLLIN, 0};
    if (poll(&readable, 1, left_ms(deadline)) != 1) return false;
    char buffer[4096];
    const ssize_t size = read(output_fd_, buffer, sizeof buffer);
    if (size <= 0) return false;
    output_.append(buffer, std::size_t(size));
    return true;
  }

  pid_t pid_ = -1;
  int output_fd_ = -1;
  std::string output_;
  std::optional<int> code_;
};

}  // namespace dmise::test
