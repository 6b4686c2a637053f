#pragma once
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files/mapped_file.h"
#include "core/sky/stars/star_catalogue.h"
#include "core/sky/stars/star_index.h"
#include "core/sky/stars/star_summary.h"

namespace dmise {

class VariableStars;  // core/sky/variables

/// A catalogue as the renderer uses it: in the index's order, with its index.
struct StarMap {
  StarTable stars;
  StarIndex index;
  StarSummary summary;
  std::vector<std::string> problems;         // `file:line: reason` of what could not be used
  std::shared_ptr<const StarBlocks> blocks;  // null: all stars were checked
  std::shared_ptr<const MappedFile> file;    // that holds the columns; null: they are in memory
  std::shared_ptr<const VariableStars> variables = {};  // among the stars; null: none is known
  bool from_cache = false;
  std::string cache_problem;  // why no cache was written; empty if there was no problem

  /// Whether all stars may be iterated over: they are few, and were checked.
  bool is_small() const { return stars.size() <= max_stars_at_once; }
};

/// Indexes a catalogue.
inline StarMap star_map_of(StarCatalogue catalogue, std::vector<std::string> problems = {}) {
  StarMap map;
  map.index = build_star_index(catalogue);
  map.stars = table_of(std::move(catalogue));
  map.summary = summary_of(map.stars);
  map.problems = std::move(problems);
  return map;
}

/// Searches a map as the function of its index does. Throws `Error` for stars of a mapped file that
/// is damaged.
inline void query_cone(const StarMap& map, const Vec<Gcrs>& axis, double radius_rad,
                       double faintest_v_mag, std::vector<std::uint32_t>& found) {
  query_cone({map.stars.v_mag.data(), map.stars.size()}, map.index, axis, radius_rad,
             faintest_v_mag, found, map.blocks.get());
}

/// Direction of a star by its proper motion, `years` after the catalogue's epoch; unit, without
/// parallax and aberration.
inline Vec<Gcrs> direction_after(const StarMap& map, std::size_t star, double years) {
  const StarTable& stars = map.stars;
  const Vec<Gcrs>& then = map.index.direction[star];
  const double ra = stars.ra_rad[star];
  const Vec<Gcrs> east{-std::sin(ra), std::cos(ra), 0.0}, north = cross(then, east);
  return unit(then + east * (years * stars.pm_ra_cosdec_rad_per_yr[star]) +
              north * (years * stars.pm_dec_rad_per_yr[star]));
}

}  // namespace dmise
