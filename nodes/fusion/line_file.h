#pragma once
#include <cstdio>
#include <string>

#include "core/base/sim_time.h"

namespace dmise {

/// A file of JSON lines in the order of a time that each line has. Methods throw `Error` "PATH:
/// reason".
class LineFile {
 public:
  /// Opens the file to append lines, and keeps those with a time before `from`. `key`: of the time,
  /// in nanoseconds.
  LineFile(std::string path, const std::string& key, SimTime from);
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  void add(const std::string& lines);

 private:
  std::string path_;
  std::FILE* file_ = nullptr;
};

}  // namespace dmise
