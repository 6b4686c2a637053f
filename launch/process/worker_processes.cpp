#include "launch/process/worker_processes.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "core/base/error.h"

namespace dmise {
namespace {

/// State of the work, in memory that all processes share.
struct Board {
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<int> failures{0};
  bool is_config_error = false;
  char failure[8192] = {};
};

class SharedBoard {
 public:
  SharedBoard() {
    void* memory =
        mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
      throw Error(std::string("no memory for workers: ") + std::strerror(errno));
    board_ = new (memory) Board;
  }
  ~SharedBoard() { munmap(board_, sizeof(Board)); }
  SharedBoard(const SharedBoard&) = delete;
  SharedBoard& operator=(const SharedBoard&) = delete;
  Board* operator->() const { return board_; }

 private:
  Board* board_;
};

[[noreturn]] void work_until_done(SharedBoard& board, std::size_t items,
                                  const std::function<void(std::size_t)>& work) {
  const auto fail = [&](const char* what, bool is_config_error) {
    if (board->failures.fetch_add(1) == 0) {
      std::strncpy(board->failure, what, sizeof board->failure - 1);
      board->is_config_error = is_config_error;
    }
    _exit(1);
  };
  try {
    for (std::size_t item = board->next++; item < items; item = board->next++) {
      work(item);
      ++board->done;
    }
  } catch (const ConfigError& e) {
    fail(e.what(), true);
  } catch (const std::exception& e) {
    fail(e.what(), false);
  }
  _exit(0);
}

/// Child processes; those still running are killed with this object.
class Children {
 public:
  ~Children() {
    for (const pid_t pid : pids_) kill(pid, SIGKILL);
    for (const pid_t pid : pids_) waitpid(pid, nullptr, 0);
  }
  void add(pid_t pid) { pids_.push_back(pid); }
  bool empty() const { return pids_.empty(); }
  /// Returns the status of one that has ended.
  std::optional<int> ended() {
    for (auto pid = pids_.begin(); pid != pids_.end(); ++pid) {
      int status = 0;
      if (waitpid(*pid, &status, WNOHANG) != *pid) continue;
      pids_.erase(pid);
      return status;
    }
    return std::nullopt;
  }

 private:
  std::vector<pid_t> pids_;
};

}  // namespace

WorkOutcome work_in_processes(std::size_t items, int workers,
                              const std::function<void(std::size_t)>& work,
                              const std::function<bool(std::size_t done)>& go_on) {
  SharedBoard board;
  Children children;
  const pid_t parent = getpid();
  for (int k = 0; k < workers && std::size_t(k) < items; ++k) {
    const pid_t pid = fork();
    if (pid < 0) throw Error(std::string("no process for a worker: ") + std::strerror(errno));
    if (pid == 0) {
      std::signal(SIGINT, SIG_DFL);
      std::signal(SIGTERM, SIG_DFL);
      if (std::signal(SIGHUP, SIG_DFL) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(1);  // it had ended before
      work_until_done(board, items, work);
    }
    children.add(pid);
  }
  WorkOutcome outcome;
  while (!children.empty()) {
    if (!go_on(board->done)) return {.interrupted = true, .failure = {}, .is_config_error = false};
    while (const auto status = children.ended()) {
      if (WIFEXITED(*status) && WEXITSTATUS(*status) == 0) continue;
      if (board->failure[0]) {
        outcome.failure = board->failure;
        outcome.is_config_error = board->is_config_error;
      } else if (WIFSIGNALED(*status)) {
        // Ctrl-C is sent to all processes of a terminal, also to this one.
        const int signal = WTERMSIG(*status);
        if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) outcome.interrupted = true;
        outcome.failure = "a worker was ended by signal " + std::to_string(signal) +
                          ": the same command continues";
      } else {
        outcome.failure = "a worker ended without a reason";
      }
      return outcome;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  go_on(board->done);
  return outcome;
}

}  // namespace dmise
