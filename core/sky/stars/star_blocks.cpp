#include "core/sky/stars/star_blocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/base/units.h"

namespace dmise {
namespace {

/// The stars of a block.
struct Rows {
  std::size_t first, last;

  Rows(std::size_t block, std::size_t stars)
      : first(block * StarBlocks::stars_per_block),
        last(std::min(stars, first + StarBlocks::stars_per_block)) {}
};

template <class T>
bool within(const Column<T>& values, Rows rows, double low, double high) {
  bool all = true;
  for (std::size_t i = rows.first; i < rows.last; ++i)
    all &= values[i] >= T(low) && values[i] <= T(high);
  return all;
}

/// The ranges of `append_star`, a little wider, because values moved to J2000.0 are not checked
/// there.
bool plausible(const StarTable& s, const Column<Vec<Gcrs>>& direction, Rows rows) {
  bool all = within(s.ra_rad, rows, 0, 2 * pi) && within(s.dec_rad, rows, -pi / 2, pi / 2) &&
             within(s.pm_ra_cosdec_rad_per_yr, rows, -150 * arcsec, 150 * arcsec) &&
             within(s.pm_dec_rad_per_yr, rows, -150 * arcsec, 150 * arcsec) &&
             within(s.parallax_rad, rows, 0, 10 * arcsec) && within(s.v_mag, rows, -50, 50);
  for (std::size_t i = rows.first; i < rows.last; ++i)
    all &= !std::isnan(s.bv[i]) && std::abs(dot(direction[i], direction[i]) - 1) < 1e-9;
  return all;
}

}  // namespace

std::uint32_t StarBlocks::crc_of(const StarTable& s, const Column<Vec<Gcrs>>& direction,
                                 std::size_t block) {
  const Rows rows(block, s.size());
  std::uint32_t crc = 0;
  for_stored_columns(s, direction, [&](const auto& column) {
    crc = crc32c(column.data() + rows.first, (rows.last - rows.first) * sizeof(column[0]), crc);
  });
  return crc;
}

StarBlocks::StarBlocks(StarTable stars, Column<Vec<Gcrs>> direction, Column<std::uint32_t> crc,
                       std::string path)
    : stars_(std::move(stars)),
      direction_(std::move(direction)),
      crc_(std::move(crc)),
      path_(std::move(path)),
      good_(std::make_unique<std::atomic<bool>[]>(count(stars_.size()))) {}

std::uint32_t StarBlocks::check(std::uint32_t star) const {
  const std::size_t block = star / stars_per_block;
  const Rows rows(block, stars_.size());
  if (!good_[block].load(std::memory_order_relaxed)) {
    const auto fail = [&](const char* why) {
      throw ConfigError(path_ + ": stars " + std::to_string(rows.first) + " to " +
                        std::to_string(rows.last - 1) + ": " + why);
    };
    if (crc_of(stars_, direction_, block) != crc_[block]) fail("the checksum is wrong");
    if (!plausible(stars_, direction_, rows)) fail("a value is out of its range");
    good_[block].store(true, std::memory_order_relaxed);
  }
  return std::uint32_t(rows.last);
}

void StarBlocks::check_all() const {
  for (std::size_t i = 0; i < stars_.size(); i += stars_per_block) check(std::uint32_t(i));
}

}  // namespace dmise
