#include "core/sky/star_cache_file.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/base/crc32c.h"
#include "core/base/error.h"
#include "core/base/mapped_file.h"
#include "core/base/regular_file.h"
#include "core/base/units.h"
#include "core/base/whole_file.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little, "the cache is little-endian");
static_assert(std::is_trivially_copyable_v<Vec<Gcrs>> && sizeof(Vec<Gcrs>) == 24);

/// Raise it whenever a reader, the index or the layout below changes.
constexpr std::uint32_t cache_version = 2;
constexpr std::array<char, 8> magic = {'D', 'M', 'I', 'S', 'S', 'T', 'A', 'R'};
constexpr std::size_t alignment = 64;

/// The file: this header, the columns in the order of `for_columns`, then the problems, each ended
/// by a line feed. Each column begins at a multiple of `alignment`, with zeros before it.
struct Header {
  std::array<char, 8> magic = dmise::magic;
  std::uint32_t version = cache_version;
  std::uint32_t crc = 0;  // of the whole file with 0 here
  std::uint32_t source_crc = 0;
  std::uint32_t bands = 0;
  std::uint64_t source_bytes = 0;
  std::uint64_t stars = 0;
  std::uint64_t cells = 0;
  std::uint64_t file_bytes = 0;
  double epoch_jyear = 0.0;
  double fastest_motion_rad_per_yr = 0.0;
  std::array<std::uint8_t, 56> unused = {};
};
static_assert(sizeof(Header) == 2 * alignment);

/// Calls `use(column, values in it)` in the order in which they are stored.
template <class Map, class Use>
void for_columns(Map& map, const Header& header, Use&& use) {
  auto& s = map.stars;
  for (auto* one :
       {&s.ra_rad, &s.dec_rad, &s.pm_ra_cosdec_rad_per_yr, &s.pm_dec_rad_per_yr, &s.parallax_rad})
    use(*one, header.stars);
  use(map.index.direction, header.stars);
  use(s.id, header.stars), use(s.v_mag, header.stars), use(s.bv, header.stars);
  use(s.flags, header.stars);
  use(map.index.first_cell, header.bands + std::uint64_t(1));
  use(map.index.first_star, header.cells + 1);
}

std::size_t padding(std::size_t bytes) { return (alignment - bytes % alignment) % alignment; }

/// Calls `use(bytes)` for what follows the header, piece by piece.
template <class Use>
void for_pieces(const StarMap& map, const Header& header, Use&& use) {
  static constexpr std::array<char, alignment> zeros = {};
  for_columns(map, header, [&](const auto& column, std::uint64_t) {
    const std::size_t bytes = column.size() * sizeof(column[0]);
    use(std::string_view(reinterpret_cast<const char*>(column.data()), bytes));
    use(std::string_view(zeros.data(), padding(bytes)));
  });
  for (const std::string& problem : map.problems) use(problem), use(std::string_view("\n"));
}

template <class T>
bool within(const Column<T>& values, double low, double high) {
  bool all = true;
  for (const T value : values) all &= value >= T(low) && value <= T(high);
  return all;
}

/// Values that `append_star` lets pass, a little wider: what moved to J2000.0 is not asked again.
bool plausible(const StarMap& map) {
  const StarTable& s = map.stars;
  bool all = s.epoch_jyear > 1500 && s.epoch_jyear < 2500 && within(s.ra_rad, 0, 2 * pi) &&
             within(s.dec_rad, -pi / 2, pi / 2) &&
             within(s.pm_ra_cosdec_rad_per_yr, -150 * arcsec, 150 * arcsec) &&
             within(s.pm_dec_rad_per_yr, -150 * arcsec, 150 * arcsec) &&
             within(s.parallax_rad, 0, 10 * arcsec) && within(s.v_mag, -50, 50);
  for (const float bv : s.bv) all &= !std::isnan(bv);
  for (const Vec<Gcrs>& d : map.index.direction) all &= std::abs(dot(d, d) - 1) < 1e-9;
  return all && map.index.fastest_motion_rad_per_yr >= 0 &&
         map.index.fastest_motion_rad_per_yr <= 300 * arcsec;
}

/// Goes through the bytes of a file.
class Reader {
 public:
  explicit Reader(std::shared_ptr<const MappedFile> file)
      : file_(std::move(file)), left_(file_->bytes()) {}

  /// Shows the next `count` values; false when they are not all there.
  template <class T>
  bool take(Column<T>& column, std::uint64_t count) {
    if (count > left_.size() / sizeof(T)) return false;
    const std::size_t bytes = count * sizeof(T);
    column = {std::span(reinterpret_cast<const T*>(left_.data()), count), file_};
    if (left_.size() < bytes + padding(bytes)) return false;
    left_ = left_.subspan(bytes + padding(bytes));
    return true;
  }

  std::string_view rest() const {
    return {reinterpret_cast<const char*>(left_.data()), left_.size()};
  }

 private:
  std::shared_ptr<const MappedFile> file_;
  std::span<const std::byte> left_;
};

std::uint32_t checksum(Header header, std::span<const std::byte> rest) {
  header.crc = 0;
  return crc32c(rest.data(), rest.size(), crc32c(&header, sizeof header));
}

/// A name beside `path` that no other process uses.
std::string own_name(const std::string& path) {
  std::random_device random;
  char ending[32];
  std::snprintf(ending, sizeof ending, ".%08x%08x", random(), random());
  return path + ending;
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
  char name[64];
  std::snprintf(name, sizeof name, "/stars-%08x-%zu-v%u.bin", source.crc, std::size_t(source.bytes),
                cache_version);
  return directory + name;
}

void write_star_cache(const std::string& path, const StarMap& map, const StarSource& source) {
  Header header{.source_crc = source.crc,
                .bands = std::uint32_t(map.index.bands),
                .source_bytes = source.bytes,
                .stars = map.stars.size(),
                .cells = map.index.first_star.size() - 1,
                .file_bytes = sizeof header,
                .epoch_jyear = map.stars.epoch_jyear,
                .fastest_motion_rad_per_yr = map.index.fastest_motion_rad_per_yr};
  for_pieces(map, header, [&](std::string_view piece) { header.file_bytes += piece.size(); });
  std::uint32_t crc = checksum(header, {});
  for_pieces(map, header,
             [&](std::string_view piece) { crc = crc32c(piece.data(), piece.size(), crc); });
  header.crc = crc;
  // Several processes may be at it: each fills a file of its own and all use the first in place.
  const std::string own = own_name(path);
  WholeFile file(own);
  file.append({reinterpret_cast<const char*>(&header), sizeof header});
  for_pieces(map, header, [&](std::string_view piece) { file.append(piece); });
  file.finish();
  if (renameat2(AT_FDCWD, own.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0) return;
  const bool there = errno == EEXIST && map_star_cache(path, source);
  const bool placed = there || rename(own.c_str(), path.c_str()) == 0;
  const int reason = errno;
  if (there || !placed) unlink(own.c_str());
  if (!placed) throw Error(path + ": can't be renamed into place: " + std::strerror(reason));
}

std::optional<StarMap> map_star_cache(const std::string& path, const StarSource& source) try {
  const auto file = std::make_shared<const MappedFile>(path);
  const auto bytes = file->bytes();
  Header header;
  if (bytes.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != magic || header.version != cache_version ||
      source != StarSource{header.source_crc, header.source_bytes} ||
      header.file_bytes != bytes.size() ||
      header.crc != checksum(header, bytes.subspan(sizeof header)))
    return std::nullopt;
  StarMap map{.file = file, .from_cache = true};
  map.stars.epoch_jyear = header.epoch_jyear;
  map.index.bands = int(header.bands);
  map.index.fastest_motion_rad_per_yr = header.fastest_motion_rad_per_yr;
  Reader reader(file);
  Column<Header> first;
  bool whole = reader.take(first, 1);
  for_columns(map, header, [&](auto& column, std::uint64_t count) {
    whole = whole && reader.take(column, count);
  });
  if (!whole || !is_sound(map.index, map.stars.size()) || !plausible(map)) return std::nullopt;
  for (std::string_view rest = reader.rest(); !rest.empty();) {
    const std::size_t end = rest.find('\n');
    if (end == rest.npos) return std::nullopt;
    map.problems.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  file->release();  // all of it was looked at; a field needs a part
  return map;
} catch (const Error&) {  // none yet, or not to be read
  return std::nullopt;
}

}  // namespace dmise
