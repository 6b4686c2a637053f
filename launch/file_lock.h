#pragma once
#include <string>

namespace dmise {

/// A lock on a file, which is made if need be and stays. The kernel gives the lock up with
/// the process, however that ends, so nobody finds a stale one. Seen by all processes that share
/// the file system of one kernel, also from different containers.
class FileLock {
 public:
  /// Makes the file and the directories above it. Throws `Error` when that fails.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

  /// False when another process holds it.
  bool take();
  /// True while another process holds it.
  bool held_elsewhere() const;

 private:
  int fd_ = -1;
  bool mine_ = false;
};

/// The lock that a run's time-master holds from the moment its directory is ready to its end.
std::string run_lock_path(const std::string& run_directory);

}  // namespace dmise
