#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "core/base/column.h"
#include "core/frames/vec.h"
#include "core/sky/stars/star_catalogue.h"

namespace dmise {

/// Calls `use(column)` for the columns of stars and for their directions, in the order in which a
/// file holds them.
template <class Stars, class Directions, class Use>
void for_stored_columns(Stars& s, Directions& direction, Use&& use) {
  use(s.ra_rad), use(s.dec_rad), use(s.pm_ra_cosdec_rad_per_yr), use(s.pm_dec_rad_per_yr);
  use(s.parallax_rad), use(direction), use(s.id), use(s.v_mag), use(s.bv), use(s.flags);
}

/// Checks stars of a mapped file when they are first looked at, block by block: a field of a large
/// catalogue is checked without reading the rest.
class StarBlocks {
 public:
  static constexpr std::uint32_t stars_per_block = 1024;
  static std::size_t count(std::size_t stars) {
    return (stars + stars_per_block - 1) / stars_per_block;
  }
  /// Checksum of all columns of a block's stars.
  static std::uint32_t crc_of(const StarTable& stars, const Column<Vec<Gcrs>>& direction,
                              std::size_t block);

  /// `crc`: of each block. `path` is for messages.
  StarBlocks(StarTable stars, Column<Vec<Gcrs>> direction, Column<std::uint32_t> crc,
             std::string path);

  /// Checks the block of a star unless that was done; returns the first star beyond it. Safe to
  /// call from several threads. Throws `ConfigError` "PATH: reason" for a wrong checksum and for
  /// values that `append_star` would refuse.
  std::uint32_t check(std::uint32_t star) const;
  void check_all() const;

 private:
  StarTable stars_;
  Column<Vec<Gcrs>> direction_;
  Column<std::uint32_t> crc_;
  std::string path_;
  std::unique_ptr<std::atomic<bool>[]> good_;  // by block
};

}  // namespace dmise
