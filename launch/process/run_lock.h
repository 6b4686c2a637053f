#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "launch/process/file_lock.h"

namespace dmise {

/// The process that holds the lock of a directory, as its lock file names it.
struct LockHolder {
  std::string host;  // name of the machine or container
  std::int64_t pid = 0;
  std::string since_utc, command;
  std::uint64_t run_id = 0;  // run of the time-master; 0: not yet known
};

/// This process.
LockHolder this_process();

/// One line of JSON with a length independent of `run_id`.
std::string lock_text(const LockHolder& holder);
/// Parses a lock file; empty if it is incomplete.
std::optional<LockHolder> parse_lock(const std::string& text);

/// "pid 123 on HOST since 2018-01-21T00:15:00Z: COMMAND"
std::string describe(const LockHolder& holder);

/// Exclusive right to write products into a directory: the kernel's lock on `DIRECTORY/.run-lock`,
/// a file that names the holder. Child processes inherit it: the directory is locked until the last
/// of them has ended, however it ends.
class RunLock {
 public:
  /// Throws `ConfigError` "DIRECTORY: is in use by ..." if another process holds it, and `Error` if
  /// the file can't be written or its file system has no locks. Processes that a dead holder has
  /// left get `patience_s` to end.
  explicit RunLock(const std::string& directory, double patience_s = 15.0);
  /// Removes the file.
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  /// Writes the run id into the lock file, for `dmise join`.
  void set_run_id(std::uint64_t run_id);

  /// Leaves the lock to the program that replaces this process by exec.
  void release_to_exec();

  /// Content of the lock file of a directory, whether its holder is alive or not.
  static std::optional<LockHolder> written_in(const std::string& directory);

 private:
  /// False if the holder may be about to end.
  bool try_to_take(const std::string& directory, bool last);
  bool write_holder();

  std::string path_;
  LockHolder self_;
  std::optional<FileLock> file_;
};

/// Creates a directory and locks it.
std::unique_ptr<RunLock> lock_directory(const std::string& directory);

}  // namespace dmise
