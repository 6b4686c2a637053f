#pragma once
#include <string>
#include <string_view>
#include <utility>

namespace dmise {

/// A file that comes into being whole or not at all: its pieces go to PATH.partial, which is
/// flushed to the disk and renamed once all are there. Methods throw `Error` "PATH: reason"; what
/// is not finished leaves nothing behind.
class WholeFile {
 public:
  explicit WholeFile(std::string path) : WholeFile(std::move(path), true) {}
  /// Goes on behind what somebody else wrote to PATH.partial.
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

/// A file of this content.
void write_file_whole(const std::string& path, std::string_view content);

}  // namespace dmise
