#include "core/sky/stars/star_map_file.h"

#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/base/files/regular_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/units.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");
static_assert(std::is_trivially_copyable_v<Vec<Gcrs>> && sizeof(Vec<Gcrs>) == 24);

constexpr std::array<char, 8> magic = {'D', 'M', 'I', 'S', 'S', 'T', 'A', 'R'};
constexpr std::size_t alignment = 64;

/// The file: this header; of each tier `first_cell` and `first_star`; the checksum of each block of
/// stars; the problems, each ended by a line feed; then the columns of the stars in the order of
/// `for_stored_columns`. Each array begins at a multiple of `alignment`, with zeros before it.
struct Header {
  std::array<char, 8> magic = dmise::magic;
  std::uint32_t version = star_map_version;
  std::uint32_t crc = 0;  // over all before the columns, with 0 here
  std::uint32_t source_crc = 0;
  std::uint32_t tiers = 0;
  std::uint64_t source_bytes = 0;
  std::uint64_t stars = 0;
  std::uint64_t problem_bytes = 0;
  std::uint64_t columns_at = 0;
  std::uint64_t file_bytes = 0;
  double epoch_jyear = 0.0;
  double fastest_motion_rad_per_yr = 0.0;
  double faintest_filled_v_mag = 0.0;
  double largest_parallax_rad = 0.0;
  std::array<std::uint64_t, 4> unused = {};
  struct Tier {
    float faintest_v_mag = 0.0F;
    std::uint32_t bands = 0;
    std::uint64_t cells = 0;
  };
  std::array<Tier, max_star_tiers> tier = {};
  std::array<std::uint64_t, StarSummary::bins> count = {};
};
static_assert(sizeof(Header) == 128 + 16 * max_star_tiers + 8 * StarSummary::bins);
static_assert(sizeof(Header) % alignment == 0);

std::size_t padding(std::size_t bytes) { return (alignment - bytes % alignment) % alignment; }

template <class T>
std::string_view bytes_of(const Column<T>& column) {
  return {reinterpret_cast<const char*>(column.data()), column.size() * sizeof(T)};
}

/// Calls `use(bytes)` for an array and what fills it up.
template <class Use>
void with_padding(std::string_view bytes, Use&& use) {
  static constexpr std::array<char, alignment> zeros = {};
  use(bytes);
  use(std::string_view(zeros.data(), padding(bytes.size())));
}

struct Tables {
  Column<std::uint32_t> block_crc;
  std::string problems;
};

/// Calls `use(bytes)` for what stands between the header and the columns, piece by piece.
template <class Use>
void for_tables(const StarMap& map, const Tables& tables, Use&& use) {
  for (const StarTier& tier : map.index.tiers) {
    with_padding(bytes_of(tier.first_cell), use);
    with_padding(bytes_of(tier.first_star), use);
  }
  with_padding(bytes_of(tables.block_crc), use);
  with_padding(tables.problems, use);
}

Tables tables_of(const StarMap& map) {
  std::vector<std::uint32_t> crc(StarBlocks::count(map.stars.size()));
  for (std::size_t block = 0; block < crc.size(); ++block)
    crc[block] = StarBlocks::crc_of(map.stars, map.index.direction, block);
  Tables tables{.block_crc = std::move(crc)};
  for (const std::string& problem : map.problems) tables.problems += problem + "\n";
  return tables;
}

Header header_of(const StarMap& map, const StarSource& source, const Tables& tables) {
  Header h{.source_crc = source.crc,
           .tiers = std::uint32_t(map.index.tiers.size()),
           .source_bytes = source.bytes,
           .stars = map.stars.size(),
           .problem_bytes = tables.problems.size(),
           .columns_at = sizeof h,
           .epoch_jyear = map.stars.epoch_jyear,
           .fastest_motion_rad_per_yr = map.index.fastest_motion_rad_per_yr,
           .faintest_filled_v_mag = map.summary.faintest_filled_v_mag,
           .largest_parallax_rad = map.summary.largest_parallax_rad,
           .count = map.summary.count};
  for (std::size_t t = 0; t < h.tiers; ++t) {
    const StarTier& tier = map.index.tiers[t];
    h.tier[t] = {tier.faintest_v_mag, std::uint32_t(tier.bands), tier.first_star.size() - 1};
  }
  for_tables(map, tables, [&](std::string_view piece) { h.columns_at += piece.size(); });
  h.file_bytes = h.columns_at;
  for_stored_columns(map.stars, map.index.direction, [&](const auto& column) {
    with_padding(bytes_of(column), [&](std::string_view piece) { h.file_bytes += piece.size(); });
  });
  h.crc = crc32c(&h, sizeof h);
  for_tables(map, tables,
             [&](std::string_view piece) { h.crc = crc32c(piece.data(), piece.size(), h.crc); });
  return h;
}

/// Goes through the bytes of a file.
class Reader {
 public:
  Reader(std::shared_ptr<const MappedFile> file, std::size_t from)
      : file_(std::move(file)), left_(file_->bytes().subspan(from)) {}

  /// Shows the next `count` values; false when they are not all there, or not zeros after them.
  template <class T>
  bool take(Column<T>& column, std::uint64_t count) {
    if (count > left_.size() / sizeof(T)) return false;
    const std::size_t bytes = count * sizeof(T);
    column = {std::span(reinterpret_cast<const T*>(left_.data()), count), file_};
    if (left_.size() < bytes + padding(bytes)) return false;
    for (const std::byte zero : left_.subspan(bytes, padding(bytes)))
      if (zero != std::byte{}) return false;
    left_ = left_.subspan(bytes + padding(bytes));
    return true;
  }
  std::size_t left() const { return left_.size(); }

 private:
  std::shared_ptr<const MappedFile> file_;
  std::span<const std::byte> left_;
};

/// Figures that the index and the summary may have.
bool plausible(const Header& h) {
  return h.epoch_jyear > 1500 && h.epoch_jyear < 2500 && h.fastest_motion_rad_per_yr >= 0 &&
         h.fastest_motion_rad_per_yr <= 300 * arcsec && h.largest_parallax_rad >= 0 &&
         h.largest_parallax_rad <= 10 * arcsec && !std::isnan(h.faintest_filled_v_mag);
}

/// Reads what the header speaks of; false when it is not there.
bool read_tables(const Header& h, Reader& reader, StarMap& map, Column<std::uint32_t>& block_crc) {
  for (std::size_t t = 0; t < h.tiers; ++t) {
    StarTier tier{.faintest_v_mag = h.tier[t].faintest_v_mag, .bands = int(h.tier[t].bands)};
    if (!reader.take(tier.first_cell, h.tier[t].bands + std::uint64_t(1)) ||
        !reader.take(tier.first_star, h.tier[t].cells + 1))
      return false;
    map.index.tiers.push_back(std::move(tier));
  }
  Column<char> problems;
  if (!reader.take(block_crc, StarBlocks::count(h.stars)) ||
      !reader.take(problems, h.problem_bytes))
    return false;
  for (std::string_view rest(problems.data(), problems.size()); !rest.empty();) {
    const std::size_t end = rest.find('\n');
    if (end == rest.npos) return false;
    map.problems.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  return true;
}

/// The header of a file, whose columns begin within it.
Header read_header(const std::string& path, std::span<const std::byte> bytes) {
  const auto fail = [&](const std::string& why) { throw ConfigError(path + ": " + why); };
  Header h;
  if (bytes.size() < sizeof h) fail("is cut short: the header is not all there");
  std::memcpy(&h, bytes.data(), sizeof h);
  if (h.magic != magic) fail("is no index of stars");
  if (h.version != star_map_version)
    fail("is an index of stars of version " + std::to_string(h.version) + ", not " +
         std::to_string(star_map_version) + ": make it anew");
  if (h.file_bytes != bytes.size())
    fail("must have " + std::to_string(h.file_bytes) + " bytes, has " +
         std::to_string(bytes.size()));
  if (h.columns_at < sizeof h || h.columns_at > bytes.size()) fail("the header is wrong");
  return h;
}

}  // namespace

bool is_star_map_file(const std::string& path) {
  std::array<char, magic.size()> begin{};
  try {
    const int file = open_regular_file(path);
    const ssize_t bytes = pread(file, begin.data(), begin.size(), 0);
    close(file);
    return bytes == ssize_t(begin.size()) && begin == magic;
  } catch (const ConfigError&) {
    return false;
  }
}

void write_star_map(const std::string& path, const StarMap& map, const StarSource& source) {
  const Tables tables = tables_of(map);
  const Header header = header_of(map, source, tables);
  WholeFile file(path);
  const auto append = [&](std::string_view piece) { file.append(piece); };
  append({reinterpret_cast<const char*>(&header), sizeof header});
  for_tables(map, tables, append);
  for_stored_columns(map.stars, map.index.direction,
                     [&](const auto& column) { with_padding(bytes_of(column), append); });
  file.finish();
}

OpenedStarMap open_star_map(const std::string& path) {
  const auto fail = [&](const char* why) { throw ConfigError(path + ": " + why); };
  const auto file = std::make_shared<const MappedFile>(path);
  const auto bytes = file->bytes();
  const Header h = read_header(path, bytes);
  Header without_crc = h;
  without_crc.crc = 0;
  if (h.crc !=
      crc32c(bytes.data() + sizeof h, h.columns_at - sizeof h, crc32c(&without_crc, sizeof h)))
    fail("the checksum of the index is wrong");
  if (h.tiers > max_star_tiers || h.stars > std::numeric_limits<std::uint32_t>::max() ||
      !plausible(h))
    fail("the header is wrong");
  OpenedStarMap opened{.map = {.file = file, .from_cache = true},
                       .source = {h.source_crc, h.source_bytes}};
  StarMap& map = opened.map;
  map.stars.epoch_jyear = h.epoch_jyear;
  map.index.fastest_motion_rad_per_yr = h.fastest_motion_rad_per_yr;
  map.summary = {h.count, h.faintest_filled_v_mag, h.largest_parallax_rad};
  Column<std::uint32_t> block_crc;
  Reader tables(file, sizeof h), columns(file, h.columns_at);
  bool whole = read_tables(h, tables, map, block_crc) && tables.left() == columns.left();
  for_stored_columns(map.stars, map.index.direction,
                     [&](auto& column) { whole = whole && columns.take(column, h.stars); });
  if (!whole || columns.left() != 0 || !is_sound(map.index, map.stars.size()))
    fail("the index is wrong");
  map.blocks = std::make_shared<const StarBlocks>(map.stars, map.index.direction,
                                                  std::move(block_crc), path);
  if (map.is_small()) {
    map.blocks->check_all();
    map.blocks = nullptr;
    file->release();  // all of it was looked at; a field needs a part
  }
  return opened;
}

std::string star_map_fingerprint(const std::string& path) {
  const MappedFile file(path);
  const Header header = read_header(path, file.bytes());
  return {reinterpret_cast<const char*>(file.bytes().data()), std::size_t(header.columns_at)};
}

}  // namespace dmise
