#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/column.h"
#include "core/frames/vec.h"
#include "core/sky/star_catalogue.h"

namespace dmise {

/// Finds the stars of a narrow field without touching the rest. The sphere is cut into bands of
/// declination and each band into cells of about equal area; a cell's stars lie together in the
/// catalogue, brightest first.
struct StarIndex {
  int bands = 0;
  Column<std::uint32_t> first_cell;  // bands + 1: number of each band's first cell
  Column<std::uint32_t> first_star;  // cells + 1: place of each cell's first star
  Column<Vec<Gcrs>> direction;       // of each star at the catalogue's epoch, unit
  double fastest_motion_rad_per_yr = 0.0;

  bool operator==(const StarIndex&) const = default;
};

/// Puts the catalogue into the index's order (by cell, then magnitude, then as it was) and indexes
/// it.
StarIndex build_star_index(StarCatalogue& catalogue);

/// Whether an index that was read is one of `stars` stars that `query_cone` can follow: with the
/// bands and cells of `build_star_index`, and no place in it beyond the stars.
bool is_sound(const StarIndex& index, std::size_t stars);

/// Appends to `found` the places in the catalogue of all stars not fainter than `faintest_v_mag`
/// within `radius_rad` of `axis` (unit) at the catalogue's epoch, in catalogue order; all stars for
/// radii from pi. For another epoch widen the radius by the years between times
/// `fastest_motion_rad_per_yr`.
void query_cone(std::span<const float> v_mag, const StarIndex& index, const Vec<Gcrs>& axis,
                double radius_rad, double faintest_v_mag, std::vector<std::uint32_t>& found);

}  // namespace dmise
