#include "core/sky/star_cache.h"

#include <bit>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/base/crc32c.h"
#include "core/base/error.h"
#include "core/base/text_file.h"
#include "core/base/whole_file.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little, "the cache is little-endian");

/// Raise it whenever a reader or the layout below changes.
constexpr std::uint32_t cache_version = 1;
constexpr char magic[8] = {'D', 'M', 'I', 'S', 'S', 'T', 'A', 'R'};

/// Layout: magic, this header, `body_bytes` of body. The body is the catalogue's arrays one after
/// another, then the problems, each ended by a line feed.
struct Header {
  std::uint32_t version = cache_version;
  std::uint32_t source_crc = 0;
  std::uint64_t source_bytes = 0;
  std::uint64_t stars = 0;
  std::uint64_t body_bytes = 0;
  std::uint32_t crc = 0;  // of this header with 0 here, and the body
  std::uint32_t unused = 0;
  double epoch_jyear = 0.0;
};

std::uint32_t checksum(Header header, std::string_view body) {
  header.crc = 0;
  return crc32c(body.data(), body.size(), crc32c(&header, sizeof header));
}

/// The arrays in the order in which they are stored.
template <class Catalogue, class Use>
void for_arrays(Catalogue& c, Use&& use) {
  use(c.ra_rad), use(c.dec_rad), use(c.pm_ra_cosdec_rad_per_yr), use(c.pm_dec_rad_per_yr);
  use(c.parallax_rad), use(c.id), use(c.v_mag), use(c.bv), use(c.flags);
}

std::string pack(const StarReading& reading, std::uint32_t source_crc, std::size_t source_bytes) {
  std::string body;
  for_arrays(reading.catalogue, [&](const auto& array) {
    body.append(reinterpret_cast<const char*>(array.data()), array.size() * sizeof(array[0]));
  });
  for (const std::string& problem : reading.problems) body += problem + '\n';
  Header header{.source_crc = source_crc,
                .source_bytes = source_bytes,
                .stars = reading.catalogue.size(),
                .body_bytes = body.size(),
                .epoch_jyear = reading.catalogue.epoch_jyear};
  header.crc = checksum(header, body);
  std::string text(magic, sizeof magic);
  text.append(reinterpret_cast<const char*>(&header), sizeof header);
  return text + body;
}

/// None unless it is whole, of this version and made of the same source.
std::optional<StarReading> unpack(const std::string& text, std::uint32_t source_crc,
                                  std::size_t source_bytes) {
  Header header;
  if (text.size() < sizeof magic + sizeof header) return std::nullopt;
  if (std::memcmp(text.data(), magic, sizeof magic) != 0) return std::nullopt;
  std::memcpy(&header, text.data() + sizeof magic, sizeof header);
  const char* at = text.data() + sizeof magic + sizeof header;
  const std::size_t left = text.size() - sizeof magic - sizeof header;
  if (header.version != cache_version || header.source_crc != source_crc ||
      header.source_bytes != source_bytes || header.body_bytes != left || header.stars > left ||
      header.crc != checksum(header, {at, left}))
    return std::nullopt;
  StarReading reading;
  reading.catalogue.epoch_jyear = header.epoch_jyear;
  const char* end = at + left;
  bool whole = true;
  for_arrays(reading.catalogue, [&](auto& array) {
    const std::size_t bytes = header.stars * sizeof(array[0]);
    whole = whole && bytes <= std::size_t(end - at);
    if (!whole) return;
    array.resize(header.stars);
    std::memcpy(array.data(), at, bytes);
    at += bytes;
  });
  if (!whole) return std::nullopt;
  for (const char* line = at; line < end;) {
    const char* stop = static_cast<const char*>(std::memchr(line, '\n', std::size_t(end - line)));
    if (!stop) return std::nullopt;
    reading.problems.emplace_back(line, stop);
    line = stop + 1;
  }
  return reading;
}

}  // namespace

StarMap load_star_map(const std::string& path, const std::string& cache_dir) {
  const std::string source = read_text_file(path);
  // Problems name the file, so its name is part of what the cache was made of.
  const std::uint32_t crc = crc32c(path.data(), path.size(), crc32c(source.data(), source.size()));
  StarMap map;
  std::optional<StarReading> reading;
  std::string cache_path;
  if (!cache_dir.empty()) {
    char name[64];
    std::snprintf(name, sizeof name, "/stars-%08x-%zu-v%u.bin", crc, source.size(), cache_version);
    cache_path = cache_dir + name;
    try {
      reading = unpack(read_text_file(cache_path), crc, source.size());
    } catch (const Error&) {
      // None yet, or not readable: it is made below.
    }
  }
  map.from_cache = reading.has_value();
  if (!reading) {
    reading = parse_stars(source, path);
    if (!cache_path.empty()) try {
        write_file_whole(cache_path, pack(*reading, crc, source.size()));
      } catch (const Error& error) {
        map.cache_problem = error.what();
      }
  }
  map.stars = std::move(reading->catalogue);
  map.problems = std::move(reading->problems);
  map.index = build_star_index(map.stars);
  return map;
}

}  // namespace dmise
