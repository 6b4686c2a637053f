#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace dmise {

/// A file's bytes, read only, in the pages that the system itself keeps of it: the processes of a
/// host that map it share one copy, and nothing is copied. They stay when the file is removed or
/// another is renamed into its place. Whoever cuts it short in place takes them away: only for
/// files that come into being whole (`WholeFile`).
class MappedFile {
 public:
  /// Throws `Error` "PATH: reason", also for what is no regular file.
  explicit MappedFile(const std::string& path);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  /// They begin on a page.
  std::span<const std::byte> bytes() const { return bytes_; }

  /// Takes the pages out of this process, also while others read them: the system keeps them, and
  /// the next who reads finds them there.
  void release() const;

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace dmise
