#pragma once
#include <string>

namespace dmise {

/// A lock on a file, which is made if need be and stays. The lock is the kernel's: it ends with the
/// process, however that ends, so nobody finds a stale one, and is seen by all that share the file
/// system, also from different containers. A program that takes this one's place (exec) keeps it.
class FileLock {
 public:
  /// Makes the file and the directories above it. Throws `Error` when that fails.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

  /// False when another process holds it.
  bool take();

 private:
  int fd_ = -1;
};

}  // namespace dmise
