#include "launch/process/file_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/regular_file.h"

namespace dmise {

FileLock::FileLock(const std::string& path) {
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), code);
  fd_ = open_own_file(path.c_str(), O_RDWR, 0666);
  if (fd_ < 0) throw Error(path + ": can't be created: " + std::strerror(errno));
}

FileLock::~FileLock() {
  if (fd_ >= 0) close(fd_);
}

FileLock::FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

bool FileLock::take() { return set(F_WRLCK, 0, 0); }

bool FileLock::take(std::int64_t byte, Use use) {
  return set(use == Use::alone ? F_WRLCK : F_RDLCK, byte, 1);
}

void FileLock::release(std::int64_t byte) { set(F_UNLCK, byte, 1); }

bool FileLock::set(short type, std::int64_t first, std::int64_t bytes) {
  // Owned by the open file, not by the process: fcntl(2), open file description locks.
  struct flock range {};
  range.l_type = type;
  range.l_whence = SEEK_SET;
  range.l_start = first;
  range.l_len = bytes;  // 0: all
  if (fcntl(fd_, F_OFD_SETLK, &range) == 0) return true;
  if (errno == EAGAIN || errno == EACCES) return false;
  throw Error(std::string("a file can't be locked: ") + std::strerror(errno));
}

}  // namespace dmise
