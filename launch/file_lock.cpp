#include "launch/file_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.h"

namespace dmise {

FileLock::FileLock(const std::string& path) {
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), code);
  fd_ = open(path.c_str(), O_RDWR | O_CREAT, 0666);
  if (fd_ < 0) throw Error(path + ": can't be created: " + std::strerror(errno));
}

FileLock::~FileLock() {
  if (fd_ >= 0) close(fd_);
}

FileLock::FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

bool FileLock::take() {
  // Owned by the open file, not by the process: fcntl(2), open file description locks.
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (fcntl(fd_, F_OFD_SETLK, &whole) == 0) return true;
  if (errno == EAGAIN || errno == EACCES) return false;
  throw Error(std::string("a file can't be locked: ") + std::strerror(errno));
}

}  // namespace dmise
