#include "nodes/fusion/line_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"

namespace dmise {

LineFile::LineFile(std::string path, const std::string& key, SimTime from)
    : path_(std::move(path)) {
  const std::string name = "\"" + key + "\":";
  std::string kept;
  {
    std::ifstream file(path_);
    std::string line;
    while (from.ns > 0 && std::getline(file, line) && !file.eof()) {
      const auto at = line.find(name);
      if (at != std::string::npos &&
          std::strtoll(line.c_str() + at + name.size(), nullptr, 10) < from.ns)
        kept += line + "\n";
    }
  }
  write_file_whole(path_, kept);
  file_ = std::fopen(path_.c_str(), "ab");
  if (!file_) throw Error(path_ + ": can't be written: " + std::strerror(errno));
}

LineFile::~LineFile() { std::fclose(file_); }

void LineFile::add(const std::string& lines) {
  if (std::fwrite(lines.data(), 1, lines.size(), file_) != lines.size() || std::fflush(file_) != 0)
    throw Error(path_ + ": can't be written: " + std::strerror(errno));
}

}  // namespace dmise
