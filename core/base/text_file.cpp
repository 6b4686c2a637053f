#include "core/base/text_file.h"

#include <sys/stat.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.h"

namespace dmise {

std::string read_text_file(const std::string& path, std::size_t limit_bytes) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) throw ConfigError(path + ": " + std::strerror(errno));
  if (S_ISDIR(info.st_mode)) throw ConfigError(path + ": is a directory");
  gzFile file = gzopen(path.c_str(), "rb");
  if (!file) throw ConfigError(path + ": " + std::strerror(errno));
  std::string text, reason;
  char buffer[1 << 16];
  int got = 0;
  while (reason.empty() && (got = gzread(file, buffer, sizeof buffer)) > 0) {
    text.append(buffer, static_cast<std::size_t>(got));
    if (text.size() > limit_bytes) reason = "larger than " + std::to_string(limit_bytes) + " bytes";
  }
  if (got < 0) reason = "can't be read or unpacked";
  gzclose(file);
  if (!reason.empty()) throw ConfigError(path + ": " + reason);
  return text;
}

}  // namespace dmise
