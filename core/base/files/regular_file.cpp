#include "core/base/files/regular_file.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

/// Returns why a file is not a regular file of a real file system; null if it is one.
const char* why_not_regular(const struct stat& info, const struct statfs& system) {
  if (S_ISDIR(info.st_mode)) return "is a directory";
  if (S_ISFIFO(info.st_mode)) return "is a FIFO, not a regular file";
  if (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode)) return "is a device, not a regular file";
  if (!S_ISREG(info.st_mode)) return "is not a regular file";
  if (system.f_type == PROC_SUPER_MAGIC || system.f_type == SYSFS_MAGIC)
    return "is a virtual file of the kernel, not a regular file";
  return nullptr;
}

/// Why an open file is not regular.
const char* why_not_regular(int file) {
  struct stat info {};
  struct statfs system {};
  if (fstat(file, &info) != 0) return "can't be examined";
  fstatfs(file, &system);
  return why_not_regular(info, system);
}

}  // namespace

int open_regular_file(const std::string& path) {
  // An embedded zero would end the name early. O_NONBLOCK makes opening a FIFO without a writer
  // return at once and has no effect on regular files.
  if (path.find('\0') != std::string::npos)
    throw ConfigError(printable(path) + ": is not a file name");
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (file < 0) throw ConfigError(printable(path) + ": " + std::strerror(errno));
  if (const char* reason = why_not_regular(file)) {
    close(file);
    throw ConfigError(printable(path) + ": " + reason);
  }
  return file;
}

int open_own_file(const char* path, int flags, mode_t mode) {
  struct stat info {};
  const bool there = lstat(path, &info) == 0;
  if (there && (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode))) {
    errno = EPERM;
    return -1;
  }
  if (there && !S_ISDIR(info.st_mode) &&
      (!S_ISREG(info.st_mode) || ((flags & O_TRUNC) != 0 && info.st_nlink > 1)))
    unlink(path);
  return open(path, flags | O_CREAT | O_NOFOLLOW | O_NOCTTY, mode);
}

std::string file_to_write(const char* option, const std::string& path) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& reason) -> ConfigError {
    return ConfigError(std::string(option) + ": " + reason + ", got " + printable(path));
  };
  struct stat info {};
  struct statfs system {};
  if (stat(path.c_str(), &info) == 0) {
    statfs(path.c_str(), &system);
    if (const char* reason = why_not_regular(info, system)) throw refuse(reason);
  }
  fs::path target = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    if (links == 40) throw refuse("too many symbolic links");  // the kernel's own limit
    const fs::path next = fs::read_symlink(target, error);
    if (error) throw refuse("can't be followed: " + error.message());
    target = target.parent_path() / next;
  }
  return target.string();
}

}  // namespace dmise
