#include "core/sky/star_merge.h"

#include <limits>
#include <vector>

#include "core/frames/vec.h"
#include "core/sky/star_index.h"

namespace dmise {

StarCatalogue merge_stars(StarCatalogue stars, const StarCatalogue& deeper) {
  StarCatalogue known = stars;
  const StarIndex index = build_star_index(known);
  std::vector<std::uint32_t> same;
  for (std::size_t i = 0; i < deeper.size(); ++i) {
    same.clear();
    query_cone(known.v_mag, index, from_spherical<Gcrs>(deeper.ra_rad[i], deeper.dec_rad[i]),
               same_star_rad, std::numeric_limits<double>::infinity(), same);
    if (!same.empty()) continue;
    stars.id.push_back(deeper.id[i]);
    stars.ra_rad.push_back(deeper.ra_rad[i]);
    stars.dec_rad.push_back(deeper.dec_rad[i]);
    stars.pm_ra_cosdec_rad_per_yr.push_back(deeper.pm_ra_cosdec_rad_per_yr[i]);
    stars.pm_dec_rad_per_yr.push_back(deeper.pm_dec_rad_per_yr[i]);
    stars.parallax_rad.push_back(deeper.parallax_rad[i]);
    stars.v_mag.push_back(deeper.v_mag[i]);
    stars.bv.push_back(deeper.bv[i]);
    stars.flags.push_back(deeper.flags[i]);
  }
  return stars;
}

}  // namespace dmise
