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

/// Returns why an open file is not a regular file of a real file system; null if it is one.
const char* why_not_regular(int file) {
  struct stat info {};
  if (fstat(file, &info) != 0) return "can't be examined";
  if (S_ISDIR(info.st_mode)) return "is a directory";
  if (S_ISFIFO(info.st_mode)) return "is a FIFO, not a regular file";
  if (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode)) return "is a device, not a regular file";
  if (!S_ISREG(info.st_mode)) return "is not a regular file";
  struct statfs system {};
  if (fstatfs(file, &system) == 0 &&
      (system.f_type == PROC_SUPER_MAGIC || system.f_type == SYSFS_MAGIC))
    return "is a virtual file of the kernel, not a regular file";
  return nullptr;
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

}  // namespace dmise
