#include "core/base/files/text_file.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/base/error.h"
#include "core/base/files/regular_file.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

using Needed = std::function<std::size_t(std::string_view)>;

/// Reads an open file to its end, or as far as `needed` says, and closes it.
std::string read_to_end(int descriptor, const std::string& name, std::size_t limit_bytes,
                        const Needed& needed = {}) {
  gzFile file = gzdopen(descriptor, "rb");
  if (!file) {
    close(descriptor);
    throw ConfigError(printable(name) + ": " + std::strerror(errno));
  }
  std::string text, reason;
  char buffer[1 << 16];
  int got = 0;
  std::size_t up_to = 0;  // bytes that are needed
  bool enough = false;
  while (reason.empty()) {
    if (needed && text.size() >= up_to) {
      up_to = needed(text);
      enough = up_to <= text.size();
    }
    if (enough) break;
    const std::size_t most = needed ? std::min(sizeof buffer, up_to - text.size()) : sizeof buffer;
    got = gzread(file, buffer, unsigned(most));
    if (got <= 0) break;
    text.append(buffer, static_cast<std::size_t>(got));
    if (text.size() > limit_bytes) reason = "larger than " + std::to_string(limit_bytes) + " bytes";
  }
  if (got < 0) reason = "can't be read or unpacked";
  if (gzclose(file) == Z_BUF_ERROR && reason.empty() && !enough)
    reason = "is cut off: its gzip data do not end";
  if (!reason.empty()) throw ConfigError(printable(name) + ": " + reason);
  return text;
}

}  // namespace

std::string read_text_file(const std::string& path, std::size_t limit_bytes) {
  return read_to_end(open_regular_file(path), path, limit_bytes);
}

std::string read_file_as_needed(const std::string& path, const Needed& needed) {
  return read_to_end(open_regular_file(path), path, std::size_t(1) << 30, needed);
}

std::string read_standard_input(std::size_t limit_bytes) {
  const int copy = dup(STDIN_FILENO);
  if (copy < 0) throw ConfigError(std::string("standard input: ") + std::strerror(errno));
  return read_to_end(copy, "standard input", limit_bytes);
}

}  // namespace dmise
