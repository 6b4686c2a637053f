#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace dmise {

/// Read-only memory mapping of a whole file: processes of a host that map it share one copy. The
/// mapping outlives removal or replacement of the file, but not truncation in place: map only files
/// that are replaced as a whole (`WholeFile`).
class MappedFile {
 public:
  /// Throws `Error` "PATH: reason" if it cannot be mapped or is not a regular file.
  explicit MappedFile(const std::string& path);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  /// Aligned to a page.
  std::span<const std::byte> bytes() const { return bytes_; }

  /// Drops the pages from this process; safe while others read. The next read faults them in again
  /// from the page cache.
  void release() const;

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace dmise
