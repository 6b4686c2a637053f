#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "launch/lock_holder.h"

namespace dmise {

/// Exclusive right to write products into a directory: `DIRECTORY/.run-lock`, a file that names the
/// holder. It is created atomically (link), so that one of several simultaneous starts wins, on any
/// file system that hosts share. The holder also locks it by fcntl, which child processes inherit:
/// the directory is locked until the last of them has ended. The holder touches the file every
/// `lock_beat_s`. The lock of an ended process is taken over (`has_ended`).
class RunLock {
 public:
  /// Throws `ConfigError` "DIRECTORY: is in use by ..." if another process holds it, and `Error` if
  /// the file cannot be written. Processes left by a dead holder get `patience_s` to end. `on_loss`
  /// is called, from a thread, with one line if the lock was removed or taken by force.
  explicit RunLock(std::string directory,
                   std::function<void(const std::string&)> on_loss = end_process,
                   double patience_s = 15.0);
  /// Removes the file.
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  /// Stores the run id in the lock, for `dmise join`.
  void set_run_id(std::uint64_t run_id);

  /// Leaves the lock to the program that replaces this process by exec.
  void release_to_exec();

  /// Content of the lock file of a directory, whether its holder is alive or not.
  static std::optional<LockHolder> written_in(const std::string& directory);

  /// Prints the line on stderr and exits with 1: another process writes to the same directory.
  static void end_process(const std::string& line);

 private:
  /// How long another holder's lock has been observed without a touch.
  struct Watch {
    double touched = 0.0;
    std::chrono::steady_clock::time_point since;
  };
  bool try_to_take(Watch& watch, bool last);
  void beat();
  std::string loss() const;

  std::string directory_, path_;
  LockHolder self_;
  int fd_ = -1;
  std::function<void(const std::string&)> on_loss_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable woken_;
  bool ending_ = false;
  std::thread beating_;
};

/// Creates a directory and locks it.
std::unique_ptr<RunLock> lock_directory(const std::string& directory);

}  // namespace dmise
