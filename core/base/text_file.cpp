#include "core/base/text_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
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

void write_file_whole(const std::string& path, const std::string& content) {
  const std::string partial = path + ".partial";
  const auto fail = [&](const char* what) {
    const int code = errno;
    unlink(partial.c_str());
    throw Error(path + ": " + what + ": " + std::strerror(code));
  };
  const int file = open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail("can't be created");
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t n = write(file, content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int code = errno;
      close(file);
      errno = code;
      fail("can't be written");
    }
    done += static_cast<std::size_t>(n);
  }
  if (fsync(file) != 0 && errno != EINVAL && errno != EROFS) {
    const int code = errno;
    close(file);
    errno = code;
    fail("can't be written");
  }
  close(file);
  if (rename(partial.c_str(), path.c_str()) != 0) fail("can't be renamed into place");
}

}  // namespace dmise
