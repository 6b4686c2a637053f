#pragma once
#include <string>
#include <string_view>
#include <utility>

namespace dmise {

/// Writes a file atomically: data goes to PATH.partial, which is flushed to the disk and renamed
/// when it is complete. Methods throw `Error` "PATH: reason"; an unfinished file is removed.
class WholeFile {
 public:
  explicit WholeFile(std::string path) : WholeFile(std::move(path), true) {}
  /// Continues a PATH.partial that another writer began.
  static WholeFile begun(std::string path) { return WholeFile(std::move(path), false); }
  static std::string partial_of(const std::string& path) { return path + ".partial"; }
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  ~WholeFile();

  void append(std::string_view piece);
  void finish();

 private:
  WholeFile(std::string path, bool empty);
  [[noreturn]] void fail(const char* what) const;
  std::string path_, partial_;
  int file_ = -1;
};

/// Writes `content` to a file atomically.
void write_file_whole(const std::string& path, std::string_view content);

}  // namespace dmise
