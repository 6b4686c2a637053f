#pragma once
#include <cstdint>
#include <vector>

#include "core/frames/vec.h"
#include "core/sky/star_catalogue.h"

namespace dmise {

/// Finds the stars of a narrow field without touching the rest. The sphere is cut into bands of
/// declination and each band into cells of about equal area; a cell's stars lie together in the
/// catalogue, brightest first.
struct StarIndex {
  int bands = 0;
  std::vector<std::uint32_t> first_cell;  // bands + 1: number of each band's first cell
  std::vector<std::uint32_t> first_star;  // cells + 1: place of each cell's first star
  std::vector<Vec<Gcrs>> direction;       // of each star at the catalogue's epoch, unit
  double fastest_motion_rad_per_yr = 0.0;
};

/// Puts the catalogue into the index's order (by cell, then magnitude, then as it was) and indexes
/// it.
StarIndex build_star_index(StarCatalogue& catalogue);

/// Appends to `found` the places in the catalogue of all stars not fainter than `faintest_v_mag`
/// within `radius_rad` of `axis` (unit) at the catalogue's epoch, in catalogue order; all stars for
/// radii from pi. For another epoch widen the radius by the years between times
/// `fastest_motion_rad_per_yr`.
void query_cone(const StarCatalogue& catalogue, const StarIndex& index, const Vec<Gcrs>& axis,
                double radius_rad, double faintest_v_mag, std::vector<std::uint32_t>& found);

}  // namespace dmise
