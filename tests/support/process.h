#pragma once
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
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
    reader_ = std::thread([this, from = ends[0]] { read_all(from); });
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ > 0 && !code_) {
      kill(SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    if (reader_.joinable()) reader_.join();
  }

  void kill(int signal) { ::kill(pid_, signal); }

  /// Everything written to stdout and stderr so far. It is read as it comes: nobody waits for room
  /// in the pipe.
  std::string output() const {
    const std::lock_guard lock(mutex_);
    return output_;
  }

  /// False when `text` was not written within the time.
  bool says(const std::string& text, double within_s = 60.0) {
    std::unique_lock lock(mutex_);
    std::size_t from = 0;
    const auto said = [&] {
      const bool found = output_.find(text, from) != std::string::npos;
      from = output_.size() - std::min(output_.size(), text.size());
      return found;
    };
    bool found = false;
    news_.wait_until(lock, after(within_s), [&] { return (found = said()) || ended_; });
    return found;
  }

  /// The exit code (128 + signal when killed), or nothing when it still runs after the time.
  std::optional<int> exit_code(double within_s = 60.0) {
    if (code_) return code_;
    const auto deadline = after(within_s);
    {
      std::unique_lock lock(mutex_);
      news_.wait_until(lock, deadline, [&] { return ended_; });  // until it closes its output
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
  void read_all(int from) {
    char buffer[4096];
    for (ssize_t size; (size = read(from, buffer, sizeof buffer)) > 0;) {
      const std::lock_guard lock(mutex_);
      output_.append(buffer, std::size_t(size));
      news_.notify_all();
    }
    close(from);
    const std::lock_guard lock(mutex_);
    ended_ = true;
    news_.notify_all();
  }

  pid_t pid_ = -1;
  mutable std::mutex mutex_;  // guards the two below
  std::string output_;
  bool ended_ = false;
  std::condition_variable news_;
  std::thread reader_;
  std::optional<int> code_;
};

}  // namespace dmise::test
