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

/// The right to write products into a directory, of one run at a time: `DIRECTORY/.run-lock`, a
/// file that says who holds it. It appears whole or not at all (link), so that one of many that
/// start at once has it, on any file system that hosts share. Its holder also locks it by fcntl,
/// which processes that it starts inherit: the directory is locked until the last of them is gone.
/// The holder touches the file every `lock_beat_s`. The lock of a process that has ended is taken
/// over (`has_ended`).
class RunLock {
 public:
  /// Throws `ConfigError` "DIRECTORY: is in use by ..." when another process holds it, and `Error`
  /// when the file can't be written. Processes that a dead holder has left get `patience_s` to end.
  /// `on_loss` is called, from a thread, with one line when the lock was removed or taken by force.
  explicit RunLock(std::string directory,
                   std::function<void(const std::string&)> on_loss = end_process,
                   double patience_s = 15.0);
  /// Removes the file.
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  /// Tells which run the directory is locked by, so that `dmise join` knows it.
  void set_run_id(std::uint64_t run_id);

  /// Leaves the lock to the program that this process becomes by exec.
  void pass_on();

  /// What the lock file of a directory says, whether its holder lives or not.
  static std::optional<LockHolder> written_in(const std::string& directory);

  /// Says the line on stderr and ends the process with 1: somebody else writes where it does.
  static void end_process(const std::string& line);

 private:
  /// Since when another's lock has been looked at without being touched.
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

/// Makes a directory and locks it.
std::unique_ptr<RunLock> lock_directory(const std::string& directory);

}  // namespace dmise
