#include "core/sky/stars/star_merge.h"

#include <limits>
#include <vector>

#include "core/frames/vec.h"
#include "core/sky/stars/star_index.h"

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
    for_columns([&](auto& to, const auto& from) { to.push_back(from[i]); }, stars, deeper);
  }
  return stars;
}

}  // namespace dmise
