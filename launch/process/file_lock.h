#pragma once
#include <cstdint>
#include <string>

namespace dmise {

/// A kernel lock on a file, which is created if necessary and kept. It ends with the process in
/// every case, so it is never stale, and is visible to all that share the file system, also from
/// different containers. It survives exec.
class FileLock {
 public:
  /// Creates the file and its parent directories. Throws `Error` if that fails.
  explicit FileLock(const std::string& path);
  /// Takes over an open file, which it closes.
  explicit FileLock(int descriptor) : fd_(descriptor) {}
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

  int descriptor() const { return fd_; }
  /// Keeps the file open and locked until the process ends.
  void leave_open() { fd_ = -1; }

  /// False if another process holds any of it. Throws `Error` if the file system has no locks.
  bool take();

  enum class Use { alone, shared };
  /// Takes one byte of the file, which need not exist: a file may have many locks. Changes the use
  /// of a byte that is held. False if that of another process forbids it; then nothing changes.
  bool take(std::int64_t byte, Use use);
  void release(std::int64_t byte);

 private:
  bool set(short type, std::int64_t first, std::int64_t bytes);
  int fd_ = -1;
};

}  // namespace dmise
