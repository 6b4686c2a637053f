#include "core/report/stars_in_frame.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {

std::vector<StarInFrame> stars_in_frame(const StarMap& map, const Wcs& wcs, int columns, int rows,
                                        double jyear, std::size_t most) {
  const Vec<Gcrs> axis = wcs_direction(wcs, {0.5 * (columns - 1), 0.5 * (rows - 1)});
  double min_cosine = 1.0;
  for (int k = 0; k <= 8; ++k)
    for (const PixelPosition edge :
         {PixelPosition{columns * k / 8.0, 0.0}, PixelPosition{columns * k / 8.0, double(rows)},
          PixelPosition{0.0, rows * k / 8.0}, PixelPosition{double(columns), rows * k / 8.0}})
      min_cosine = std::min(min_cosine, dot(wcs_direction(wcs, edge), axis));
  const auto& stars = map.stars;
  const double years = jyear - stars.epoch_jyear;
  const double radius_rad =
      std::min(pi, std::acos(std::clamp(min_cosine, -1.0, 1.0)) +
                       std::abs(years) * map.index.fastest_motion_rad_per_yr + 0.1 * deg);
  std::vector<StarInFrame> out;
  std::vector<std::uint32_t> found;
  for (double faintest = 2.0; faintest <= 16.0; faintest += 1.0) {
    found.clear();
    out.clear();
    query_cone(map, axis, radius_rad, faintest, found);
    for (const std::uint32_t i : found) {
      const Vec<Gcrs> now = direction_after(map, i, years);
      const auto pixel = wcs_pixel(wcs, now);
      if (!pixel || !(pixel->x_px > -0.5) || !(pixel->y_px > -0.5) ||
          !(pixel->x_px < columns - 0.5) || !(pixel->y_px < rows - 0.5) ||
          !wcs_sees_sky(wcs, *pixel))
        continue;
      const auto [ra_now, dec_now] = to_spherical(now);
      out.push_back({stars.id[i], *pixel, ra_now, dec_now, double(stars.v_mag[i])});
    }
    if (out.size() >= most || found.size() > 20 * most) break;
  }
  std::ranges::stable_sort(out, {}, &StarInFrame::v_mag);
  if (out.size() > most) out.resize(most);
  return out;
}

}  // namespace dmise
