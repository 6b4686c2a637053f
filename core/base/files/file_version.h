#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace dmise {

/// Which regular file lies at a path, and when it was last changed. Equal versions have the same
/// content.
struct FileVersion {
  std::string path;  // as given
  std::uint64_t device = 0, inode = 0;
  std::int64_t size = 0;
  std::array<std::int64_t, 4> changed = {};  // content and inode: seconds and nanoseconds

  bool operator==(const FileVersion&) const = default;
};

/// None of what is no regular file, and of one that was changed within the last 50 ms: it may
/// change again with the same times, which are those of the kernel's ticks.
std::optional<FileVersion> file_version(const std::string& path);

}  // namespace dmise
