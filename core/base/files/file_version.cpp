#include "core/base/files/file_version.h"

#include <sys/stat.h>

#include <chrono>

namespace dmise {
namespace {

constexpr std::chrono::milliseconds settling{50};

std::chrono::nanoseconds since_epoch(const timespec& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

std::optional<FileVersion> file_version(const std::string& path) {
  struct stat info = {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  if (now - since_epoch(info.st_ctim) < settling) return std::nullopt;
  return FileVersion{.path = path,
                     .device = info.st_dev,
                     .inode = info.st_ino,
                     .size = info.st_size,
                     .changed = {info.st_mtim.tv_sec, info.st_mtim.tv_nsec, info.st_ctim.tv_sec,
                                 info.st_ctim.tv_nsec}};
}

}  // namespace dmise
