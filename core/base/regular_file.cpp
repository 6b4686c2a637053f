#include "core/base/regular_file.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

/// What an open file is, other than a regular file of a real file system; null if it is that.
const char* oddity_of(int file) {
  struct stat info {};
  if (fstat(file, &info) != 0) return "can't be looked at";
  if (S_ISDIR(info.st_mode)) return "is a directory";
  if (S_ISFIFO(info.st_mode)) return "is no regular file but a FIFO";
  if (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode)) return "is no regular file but a device";
  if (!S_ISREG(info.st_mode)) return "is no regular file";
  struct statfs system {};
  if (fstatfs(file, &system) == 0 &&
      (system.f_type == PROC_SUPER_MAGIC || system.f_type == SYSFS_MAGIC))
    return "is no regular file but made up by the kernel";
  return nullptr;
}

}  // namespace

int open_regular_file(const std::string& path) {
  // An embedded zero would end the name early; O_NONBLOCK keeps a FIFO without a writer from
  // holding the program, and means nothing to regular files.
  if (path.find('\0') != std::string::npos)
    throw ConfigError(printable(path) + ": no name of a file");
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (file < 0) throw ConfigError(printable(path) + ": " + std::strerror(errno));
  if (const char* oddity = oddity_of(file)) {
    close(file);
    throw ConfigError(printable(path) + ": " + oddity);
  }
  return file;
}

}  // namespace dmise
