#include "core/orbit/geodetic_track.h"

#include <algorithm>
#include <cmath>

#include "core/base/files/text_file.h"
#include "core/frames/geodesy.h"
#include "core/orbit/time_table.h"

namespace dmise {
namespace {

constexpr double min_height_m = 2.0, max_height_m = 1e9;  // lower is below the ground

/// Slope at point `i` of the parabola through it and its neighbours; at an end through the three
/// points there.
Vec<OemAxes> slope_at(const OemSegment& s, std::size_t i) {
  const auto difference = [&](std::size_t a, std::size_t b) {
    return (s.position_m[b] - s.position_m[a]) * (1.0 / (s.time_s[b] - s.time_s[a]));
  };
  const std::size_t size = s.time_s.size();
  if (size == 2) return difference(0, 1);
  const std::size_t middle = std::clamp<std::size_t>(i, 1, size - 2);
  const Vec<OemAxes> before = difference(middle - 1, middle),
                     after = difference(middle, middle + 1);
  const double span_s = s.time_s[middle + 1] - s.time_s[middle - 1];
  const Vec<OemAxes> bend = (after - before) * (1.0 / span_s);  // half the second derivative
  return before + bend * (2 * s.time_s[i] - s.time_s[middle - 1] - s.time_s[middle]);
}

/// A table of `columns`; `place` turns a row into a position in ITRS.
template <class Place>
Trajectory track_of(std::string_view text, const std::string& source, const Tai& start,
                    const std::string& name, std::string_view columns, const Place& place) {
  OemSegment s{.object_name = name,
               .frame = OemFrame::itrs,
               .interpolation = OemInterpolation::hermite,
               .degree = 3};
  parse_time_table(text, source, columns, [&](const TimeTableRow& row) {
    const Vec<Itrs> p = place(row);
    s.time_s.push_back(row.values[0]);
    s.position_m.push_back({p.x, p.y, p.z});
  });
  for (std::size_t i = 0; i < s.time_s.size(); ++i) s.velocity_m_per_s.push_back(slope_at(s, i));
  s.usable_start_s = s.time_s.front();
  s.usable_stop_s = s.time_s.back();
  return {source, start, {std::move(s)}};
}

}  // namespace

Trajectory parse_geodetic_track(std::string_view text, const std::string& source, const Tai& start,
                                const std::string& name, const Ellipsoid& ellipsoid) {
  return track_of(text, source, start, name, "time_s,latitude_deg,longitude_deg,height_m",
                  [&](const TimeTableRow& row) {
                    const Site site{row.values[1], row.values[2], row.values[3], ellipsoid};
                    if (std::abs(site.latitude_deg) > 90 || std::abs(site.longitude_deg) > 360 ||
                        !(site.height_m >= min_height_m && site.height_m <= max_height_m))
                      row.fail(
                          "latitude must be in -90..90, longitude in -360..360 and height in "
                          "2..1e9 m");
                    return itrs_from_geodetic(site);
                  });
}

Trajectory read_enu_track(const std::string& path, const Tai& start, const std::string& name,
                          const Site& origin) {
  const Vec<Itrs> origin_m = itrs_from_geodetic(origin);
  const auto itrs_from_enu = enu_from_itrs(origin).inverse();
  return track_of(read_text_file(path), path, start, name, "time_s,east_m,north_m,up_m",
                  [&](const TimeTableRow& row) {
                    const Vec<Enu> place{row.values[1], row.values[2], row.values[3]};
                    if (!(norm(place) <= max_height_m)) row.fail("must be within 1e9 m");
                    const Vec<Itrs> p = origin_m + itrs_from_enu * place;
                    if (!(geodetic_from_itrs(p, origin.ellipsoid).height_m >= min_height_m))
                      row.fail("must be 2 m above the ellipsoid or higher");
                    return p;
                  });
}

Trajectory read_geodetic_track(const std::string& path, const Tai& start, const std::string& name,
                               const Ellipsoid& ellipsoid) {
  return parse_geodetic_track(read_text_file(path), path, start, name, ellipsoid);
}

}  // namespace dmise
