#include "core/sky/stars/star_cache.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/sky/stars/star_cache_file.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t header_bytes = 2944, crc_at = 12, columns_at_at = 48, figures_at = 64;

class StarCache : public testing::Test {
 protected:
  void SetUp() override {
    std::string made = (fs::path(testing::TempDir()) / "dmise-stars-XXXXXX").string();
    ASSERT_NE(mkdtemp(made.data()), nullptr);
    directory_ = made;
    source_ = directory_ + "/stars.csv";
    fs::create_directory(cache_ = directory_ + "/cache");
    write_file_whole(source_, "ra_deg,dec_deg,mag_v,bv\n10,20,3,0.1\n11,95,4,\n12,22,4,\n");
  }
  void TearDown() override { fs::remove_all(directory_); }

  std::string cached() const {
    for (const auto& entry : fs::directory_iterator(cache_)) return entry.path().string();
    return {};
  }
  auto files() const { return std::distance(fs::directory_iterator(cache_), {}); }

  /// As `write_file_whole`, without waiting for the disk.
  void place(const std::string& content) const {
    const std::string beside = directory_ + "/beside";
    std::ofstream(beside, std::ios::binary) << content;
    fs::rename(beside, star_cache_path(cache_, *star_source(source_)));
  }

  std::string directory_, source_, cache_;
};

void expect_same(const StarMap& a, const StarMap& b) {
  EXPECT_EQ(a.stars, b.stars);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.summary, b.summary);
  EXPECT_EQ(a.problems, b.problems);
}

/// A file with the checksum that belongs to what stands before its columns.
std::string sealed(std::string file) {
  std::memset(file.data() + crc_at, 0, 4);
  std::uint64_t columns_at = 0;
  std::memcpy(&columns_at, file.data() + columns_at_at, 8);
  const std::uint32_t crc = crc32c(file.data(), std::min<std::size_t>(columns_at, file.size()));
  std::memcpy(file.data() + crc_at, &crc, 4);
  return file;
}

TEST_F(StarCache, TheSecondTimeGivesTheSameFromTheCache) {
  const StarMap fresh = load_star_map(source_);
  const StarMap first = load_star_map(source_, cache_), second = load_star_map(source_, cache_);
  EXPECT_FALSE(first.from_cache);
  EXPECT_TRUE(second.from_cache);
  expect_same(first, fresh);
  expect_same(second, fresh);
  EXPECT_EQ(first.problems.size(), 1u);
  EXPECT_EQ(first.stars.size(), 2u);
  EXPECT_EQ(files(), 1);
}

TEST_F(StarCache, AnotherSourceIsReadAnew) {
  load_star_map(source_, cache_);
  write_file_whole(source_, "ra_deg,dec_deg,mag_v\n1,2,3\n");
  const StarMap map = load_star_map(source_, cache_);
  EXPECT_FALSE(map.from_cache);
  EXPECT_EQ(map.stars.size(), 1u);
}

TEST_F(StarCache, AMapUnderAnothersNameIsPassedOver) {
  load_star_map(source_, cache_);
  const std::string foreign = read_text_file(cached());
  fs::remove(cached());
  write_file_whole(source_, "ra_deg,dec_deg,mag_v\n1,2,3\n");
  place(foreign);
  EXPECT_FALSE(load_star_map(source_, cache_).from_cache);
  const StarMap map = load_star_map(source_, cache_);
  EXPECT_TRUE(map.from_cache);
  EXPECT_EQ(map.stars.size(), 1u);
}

// Each byte of the header's first fields, and every so often one of the rest.
TEST_F(StarCache, DamageIsPassedOver) {
  load_star_map(source_, cache_);
  const StarSource source = *star_source(source_);
  const std::string path = cached(), whole = read_text_file(path);
  for (std::size_t at = 0; at < whole.size(); at += at < figures_at ? 1 : 97) {
    std::string damaged = whole;
    damaged[at] = char(damaged[at] ^ 0x40);
    place(damaged);
    EXPECT_FALSE(map_star_cache(path, source)) << at;
    place(whole.substr(0, at));
    EXPECT_FALSE(map_star_cache(path, source)) << at;
  }
  place(whole + '\n');
  EXPECT_FALSE(map_star_cache(path, source));
  place(whole);
  EXPECT_TRUE(map_star_cache(path, source));
}

TEST_F(StarCache, DamageIsMended) {
  const StarMap first = load_star_map(source_, cache_);
  const std::string whole = read_text_file(cached());
  for (const std::size_t at : {std::size_t(0), crc_at, header_bytes, whole.size() - 1}) {
    std::string damaged = whole;
    damaged[at] = char(damaged[at] ^ 0x40);
    place(damaged);
    const StarMap again = load_star_map(source_, cache_);
    EXPECT_FALSE(again.from_cache) << at;
    EXPECT_EQ(again.cache_problem, "");
    expect_same(again, first);
    EXPECT_EQ(files(), 1);
    EXPECT_EQ(read_text_file(cached()), whole);
  }
  EXPECT_TRUE(load_star_map(source_, cache_).from_cache);
}

// Bytes that pass for whole: counts and places that lead beyond the stars, and values that are no
// place, magnitude or colour.
TEST_F(StarCache, WhatLeadsAstrayIsPassedOverThoughItIsWhole) {
  load_star_map(source_, cache_);
  const StarSource source = *star_source(source_);
  const std::string path = cached(), whole = read_text_file(path);
  place(sealed(whole));
  ASSERT_TRUE(map_star_cache(path, source));
  // Each number of the header: figures and counts of the catalogue may be other than they were.
  for (const std::uint32_t value : {0U, 1U, 7U, 0x7fffffffU, 0x80000000U, 0xffffffffU})
    for (std::size_t at = 0; at < header_bytes; at += 4) {
      std::string changed = whole;
      std::memcpy(changed.data() + at, &value, 4);
      if (changed == whole || at == crc_at) continue;
      place(sealed(changed));
      const auto kept = map_star_cache(path, source);
      if (!kept) continue;
      EXPECT_GE(at, figures_at);
      std::vector<std::uint32_t> found;
      query_cone(*kept, {0, 0, 1}, 4.0, 99.0, found);
      EXPECT_EQ(found, (std::vector<std::uint32_t>{0, 1}));
    }
}

/// A column in which one value is another.
template <class T>
Column<T> spoilt(const Column<T>& column, std::size_t i, T value) {
  std::vector<T> values(column.begin(), column.end());
  values[i] = value;
  return values;
}

TEST_F(StarCache, WrongValuesArePassedOverThoughTheirChecksumsAreRight) {
  const StarMap right = load_star_map(source_);
  const std::string path = directory_ + "/map";
  const auto is_refused = [&](const auto& spoil) {
    StarMap map = right;
    spoil(map);
    write_star_map(path, map, {});
    EXPECT_THROW(open_star_map(path), Error);
  };
  write_star_map(path, right, {});
  expect_same(open_star_map(path).map, right);
  const StarTier& tier = right.index.tiers[0];
  for (const std::size_t i :
       {std::size_t(0), tier.first_star.size() / 2, tier.first_star.size() - 1})
    for (const std::uint32_t value : {3U, 0x7fffffffU, 0xffffffffU})
      is_refused(
          [&](StarMap& m) { m.index.tiers[0].first_star = spoilt(tier.first_star, i, value); });
  for (std::size_t i = 0; i < tier.first_cell.size(); ++i)
    is_refused(
        [&](StarMap& m) { m.index.tiers[0].first_cell = spoilt(tier.first_cell, i, 12345U); });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto spoil_star = [&](auto StarTable::*column, auto value) {
    is_refused([&](StarMap& m) { m.stars.*column = spoilt(right.stars.*column, 1, value); });
  };
  for (const double value : {nan, 1e300, -1e300}) {
    is_refused([&](StarMap& m) {
      m.index.direction = spoilt(right.index.direction, 1, Vec<Gcrs>{value, 0, 0});
    });
    for (auto column :
         {&StarTable::ra_rad, &StarTable::dec_rad, &StarTable::pm_ra_cosdec_rad_per_yr,
          &StarTable::pm_dec_rad_per_yr, &StarTable::parallax_rad})
      spoil_star(column, value);
    spoil_star(&StarTable::v_mag, float(value));
  }
  spoil_star(&StarTable::bv, float(nan));
}

// A large map is not read as a whole: a damaged block is found when its stars are looked for.
TEST_F(StarCache, DamageOfALargeMapIsFoundWhereItIs) {
  StarCatalogue stars;
  const std::size_t count = max_stars_at_once + 5000;
  for (std::size_t i = 0; i < count; ++i)
    append_star(stars, {.id = std::uint32_t(i),
                        .ra_rad = 6.28 * double(i) / double(count),
                        .dec_rad = std::asin(-1 + 2 * std::fmod(0.618034 * double(i), 1.0)),
                        .v_mag = 12.0});
  const std::string path = directory_ + "/large";
  write_star_map(path, star_map_of(std::move(stars)), {});
  const auto search = [](const StarMap& map, double dec_sign) {
    std::vector<std::uint32_t> found;
    query_cone(map, {0, 0, dec_sign}, 0.05, 99.0, found);
    return found;
  };
  StarMap map = open_star_map(path).map;
  ASSERT_FALSE(search(map, 1).empty());
  ASSERT_FALSE(search(map, -1).empty());
  // The right ascension of the star that is first in the file, at the southern pole.
  const auto* begin = reinterpret_cast<const char*>(map.file->bytes().data());
  const auto at = reinterpret_cast<const char*>(map.stars.ra_rad.data()) - begin;
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(at);
    file.put('\x55');
  }
  map = open_star_map(path).map;
  EXPECT_FALSE(search(map, 1).empty());
  try {
    search(map, -1);
    ADD_FAILURE() << "the damage was not found";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.what(), path + ": stars 0 to 1023: the checksum is wrong");
  }
  fs::resize_file(path, fs::file_size(path) - 64);
  EXPECT_THROW(open_star_map(path), ConfigError);
}

// Also of the process that made the file: what it read itself is given up.
TEST_F(StarCache, ColumnsBeginOnCacheLinesOfTheMappedFile) {
  const StarMap made = load_star_map(source_, cache_), kept = load_star_map(source_, cache_);
  std::vector<std::array<std::uintptr_t, 2>> mapped;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (!line.ends_with(cached())) continue;
    EXPECT_NE(line.find(" r--s "), line.npos) << line;
    char* end = nullptr;
    const std::uintptr_t from = std::strtoull(line.c_str(), &end, 16);
    mapped.push_back({from, std::strtoull(end + 1, nullptr, 16)});
  }
  ASSERT_EQ(mapped.size(), 2u);
  const auto expect_inside = [&](const auto& column) {
    const auto at = std::bit_cast<std::uintptr_t>(column.data());
    EXPECT_EQ(at % 64, 0u);
    EXPECT_TRUE(std::ranges::any_of(
        mapped, [&](const auto& range) { return range[0] <= at && at < range[1]; }));
  };
  for (const StarMap* map : {&made, &kept}) {
    const StarTable& s = map->stars;
    expect_inside(s.id), expect_inside(s.ra_rad), expect_inside(s.dec_rad);
    expect_inside(s.pm_ra_cosdec_rad_per_yr), expect_inside(s.pm_dec_rad_per_yr);
    expect_inside(s.parallax_rad), expect_inside(s.v_mag), expect_inside(s.bv);
    expect_inside(s.flags), expect_inside(map->index.direction);
    expect_inside(map->index.tiers[0].first_cell), expect_inside(map->index.tiers[0].first_star);
  }
}

TEST_F(StarCache, WhatIsMappedStaysWhenTheFileIsReplacedAndRemoved) {
  const StarMap fresh = load_star_map(source_);
  load_star_map(source_, cache_);
  const StarMap mapped = load_star_map(source_, cache_);
  ASSERT_TRUE(mapped.from_cache);
  place(std::string(read_text_file(cached()).size(), 'x'));
  expect_same(mapped, fresh);
  place("");
  expect_same(mapped, fresh);
  EXPECT_FALSE(load_star_map(source_, cache_).from_cache);
  fs::remove_all(cache_);
  expect_same(mapped, fresh);
  const auto copy = std::make_unique<StarMap>(mapped);
  expect_same(*copy, fresh);
}

TEST_F(StarCache, ProcessesThatMakeItAtOnceLeaveOne) {
  const StarMap fresh = load_star_map(source_);
  std::vector<pid_t> children;
  for (int i = 0; i < 8; ++i) {
    children.push_back(fork());
    ASSERT_GE(children.back(), 0);
    if (children.back() == 0) {
      const StarMap map = load_star_map(source_, cache_);
      const bool same = map.stars == fresh.stars && map.index == fresh.index;
      _exit(same && map.cache_problem.empty() ? 0 : 1);
    }
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(files(), 1);
  EXPECT_TRUE(load_star_map(source_, cache_).from_cache);
}

TEST_F(StarCache, NoPlaceToKeepItIsNoError) {
  const StarMap map = load_star_map(source_, source_ + "/below-a-file");
  EXPECT_EQ(map.stars.size(), 2u);
  EXPECT_FALSE(map.cache_problem.empty());
  fs::create_directories(star_cache_path(cache_, *star_source(source_)) + "/taken");
  const StarMap other = load_star_map(source_, cache_);
  EXPECT_FALSE(other.cache_problem.empty());
  expect_same(other, map);
  EXPECT_EQ(files(), 1);
}

// A pipe can be read once and may have no end.
TEST_F(StarCache, WhatIsNoRegularFileIsRefused) {
  int ends[2] = {};
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_THROW(load_star_map("/dev/fd/" + std::to_string(ends[0]), cache_), ConfigError);
  EXPECT_THROW(load_star_map("/dev/zero", cache_), ConfigError);
  close(ends[0]);
  close(ends[1]);
  EXPECT_TRUE(fs::is_empty(cache_));
}

}  // namespace
}  // namespace dmise
