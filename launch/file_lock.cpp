#include "launch/file_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Of the whole file. Its owner is the open file, not the process (fcntl(2), open file description
/// locks), and looking at it takes nothing.
struct flock exclusive() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

FileLock::FileLock(const std::string& path) {
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), code);
  fd_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ < 0) throw Error(path + ": can't be made: " + std::strerror(errno));
}

FileLock::~FileLock() {
  if (fd_ >= 0) close(fd_);
}

FileLock::FileLock(FileLock&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), mine_(other.mine_) {}

bool FileLock::take() {
  struct flock whole = exclusive();
  mine_ = mine_ || fcntl(fd_, F_OFD_SETLK, &whole) == 0;
  return mine_;
}

bool FileLock::held_elsewhere() const {
  struct flock whole = exclusive();
  if (fcntl(fd_, F_OFD_GETLK, &whole) != 0)
    throw Error(std::string("a lock can't be looked at: ") + std::strerror(errno));
  return whole.l_type != F_UNLCK;
}

std::string run_lock_path(const std::string& run_directory) { return run_directory + "/.run.lock"; }

}  // namespace dmise
