#include "core/base/files/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/regular_file.h"

namespace dmise {

WholeFile::WholeFile(std::string path, bool empty)
    : path_(std::move(path)), partial_(partial_of(path_)) {
  file_ = empty ? open_own_file(partial_.c_str(), O_WRONLY | O_CLOEXEC | O_TRUNC)
                : open(partial_.c_str(), O_WRONLY | O_CLOEXEC | O_APPEND | O_NOFOLLOW);
  if (file_ < 0) fail("can't be created");
}

WholeFile::~WholeFile() {
  if (file_ < 0) return;
  close(file_);
  unlink(partial_.c_str());
}

void WholeFile::append(std::string_view piece) {
  while (!piece.empty()) {
    const ssize_t n = write(file_, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("can't be written");
    piece.remove_prefix(std::size_t(n));
  }
}

void WholeFile::finish() {
  if (fsync(file_) != 0 && errno != EINVAL && errno != EROFS) fail("can't be written");
  if (rename(partial_.c_str(), path_.c_str()) != 0) fail("can't be renamed into place");
  close(std::exchange(file_, -1));
}

void WholeFile::fail(const char* what) const {
  throw Error(path_ + ": " + what + ": " + std::strerror(errno));
}

void write_file_whole(const std::string& path, std::string_view content) {
  WholeFile file(path);
  file.append(content);
  file.finish();
}

}  // namespace dmise
