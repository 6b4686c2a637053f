#include "core/sky/stars/star_cache_file.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/base/files/regular_file.h"
#include "core/base/formatted.h"

namespace dmise {
namespace {

/// A name beside `path` that no other process uses.
std::string own_name(const std::string& path) {
  std::random_device random;
  return path + formatted(".%08x%08x", random(), random());
}

}  // namespace

std::optional<StarSource> star_source(const std::string& path) {
  int file = -1;
  try {
    file = open_regular_file(path);
  } catch (const ConfigError&) {
    return std::nullopt;
  }
  bool whole = true;
  StarSource source;
  std::array<char, 1 << 16> piece;
  for (ssize_t n = 1; whole && n != 0;) {
    n = read(file, piece.data(), piece.size());
    if (n < 0) whole = errno == EINTR;
    if (n <= 0) continue;
    source.crc = crc32c(piece.data(), std::size_t(n), source.crc);
    source.bytes += std::uint64_t(n);
  }
  close(file);
  source.crc = crc32c(path.data(), path.size(), source.crc);
  return whole ? std::optional(source) : std::nullopt;
}

std::string star_cache_path(const std::string& directory, const StarSource& source) {
  return directory + formatted("/stars-%08x-%zu-v%u.bin", source.crc, std::size_t(source.bytes),
                               star_map_version);
}

void write_star_cache(const std::string& path, const StarMap& map, const StarSource& source) {
  // Several processes may write at once: each fills a file of its own, and all use the first that
  // is in place.
  const std::string own = own_name(path);
  write_star_map(own, map, source);
  if (renameat2(AT_FDCWD, own.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0) return;
  const bool there = errno == EEXIST && map_star_cache(path, source);
  const bool placed = there || rename(own.c_str(), path.c_str()) == 0;
  const int reason = errno;
  if (there || !placed) unlink(own.c_str());
  if (!placed) throw Error(path + ": can't be renamed into place: " + std::strerror(reason));
}

std::optional<StarMap> map_star_cache(const std::string& path, const StarSource& source) try {
  OpenedStarMap opened = open_star_map(path);
  if (opened.source != source) return std::nullopt;
  return std::move(opened.map);
} catch (const Error&) {  // none yet, or not to be read
  return std::nullopt;
}

}  // namespace dmise
