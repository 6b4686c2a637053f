#pragma once
#include <string>

namespace dmise {

/// A kernel lock on a file, which is created if necessary and kept. It ends with the process in
/// every case, so it is never stale, and is visible to all that share the file system, also from
/// different containers. It survives exec.
class FileLock {
 public:
  /// Creates the file and its parent directories. Throws `Error` if that fails.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

  /// False if another process holds it.
  bool take();

 private:
  int fd_ = -1;
};

}  // namespace dmise
