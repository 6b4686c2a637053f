#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/column.h"
#include "core/frames/vec.h"
#include "core/sky/stars/star_blocks.h"
#include "core/sky/stars/star_catalogue.h"

namespace dmise {

/// Stars of a range of magnitudes by their place: the sphere is cut into bands of declination and
/// each band into cells of about equal area.
struct StarTier {
  float faintest_v_mag = 0.0F;  // all its stars are brighter or equal; of the last: infinity
  int bands = 0;
  Column<std::uint32_t> first_cell;  // bands + 1: number of each band's first cell
  Column<std::uint32_t> first_star;  // cells + 1: place of each cell's first star

  bool operator==(const StarTier&) const = default;
};

/// Finds the stars of a narrow field without touching the rest, and bright stars without touching
/// faint ones. The catalogue is sorted by tier, then by cell, then by magnitude.
struct StarIndex {
  std::vector<StarTier> tiers;  // by rising magnitude; at least one
  Column<Vec<Gcrs>> direction;  // for each star at the catalogue's epoch, unit
  double fastest_motion_rad_per_yr = 0.0;

  bool operator==(const StarIndex&) const = default;
};

inline constexpr std::size_t max_star_tiers = 16;

/// A catalogue of up to this many stars has one tier, is checked whole when it is mapped, and may
/// be iterated over.
inline constexpr std::size_t max_stars_at_once = 1'000'000;

/// Sorts the catalogue by tier, cell and magnitude (stable) and indexes it.
StarIndex build_star_index(StarCatalogue& catalogue);

/// Whether an index that was read is one of `stars` stars that `query_cone` can follow: with the
/// tiers, bands and cells of `build_star_index`, and no place in it beyond the stars.
bool is_sound(const StarIndex& index, std::size_t stars);

/// Appends to `found` the places in the catalogue of all stars not fainter than `faintest_v_mag`
/// within `radius_rad` of `axis` (unit) at the catalogue's epoch, in catalogue order; all stars for
/// radii from pi. For another epoch widen the radius by the years between times
/// `fastest_motion_rad_per_yr`. `blocks` checks stars before they are read; null for none.
void query_cone(std::span<const float> v_mag, const StarIndex& index, const Vec<Gcrs>& axis,
                double radius_rad, double faintest_v_mag, std::vector<std::uint32_t>& found,
                const StarBlocks* blocks = nullptr);

}  // namespace dmise
