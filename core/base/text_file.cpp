#include "core/base/text_file.h"

#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/regular_file.h"

namespace dmise {
namespace {

/// Reads an open file to its end and closes it.
std::string read_to_end(int descriptor, const std::string& name, std::size_t limit_bytes) {
  gzFile file = gzdopen(descriptor, "rb");
  if (!file) {
    close(descriptor);
    throw ConfigError(printable(name) + ": " + std::strerror(errno));
  }
  std::string text, reason;
  char buffer[1 << 16];
  int got = 0;
  while (reason.empty() && (got = gzread(file, buffer, sizeof buffer)) > 0) {
    text.append(buffer, static_cast<std::size_t>(got));
    if (text.size() > limit_bytes) reason = "larger than " + std::to_string(limit_bytes) + " bytes";
  }
  if (got < 0) reason = "can't be read or unpacked";
  if (gzclose(file) == Z_BUF_ERROR && reason.empty())
    reason = "is cut off: its gzip data do not end";
  if (!reason.empty()) throw ConfigError(printable(name) + ": " + reason);
  return text;
}

}  // namespace

std::string read_text_file(const std::string& path, std::size_t limit_bytes) {
  return read_to_end(open_regular_file(path), path, limit_bytes);
}

std::string read_standard_input(std::size_t limit_bytes) {
  const int copy = dup(STDIN_FILENO);
  if (copy < 0) throw ConfigError(std::string("standard input: ") + std::strerror(errno));
  return read_to_end(copy, "standard input", limit_bytes);
}

}  // namespace dmise
