#include "bench/validation/observed_light.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "bench/validation/pass_orbit.h"
#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/frames/geodesy.h"
#include "core/orbit/two_body.h"
#include "core/sky/bodies/shadow.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr Site mount_lemmon{.latitude_deg = 32.4434, .longitude_deg = -110.7881, .height_m = 2790};
constexpr Site mmt_9{.latitude_deg = 43.65, .longitude_deg = 41.43, .height_m = 2030};
constexpr std::size_t points_of_fit = 15;
constexpr double min_km = 100.0, max_km = 1e5;  // bounds of heights and ranges
constexpr double brightest_mag = -10.0, faintest_mag = 25.0;

/// Rows of a CSV with a header; lines that begin with # are comments.
class Table {
 public:
  explicit Table(const std::string& path) : path_(path), text_(read_text_file(path)) {
    LineReader lines(text_);
    while (const auto line = lines.next()) {
      if (trimmed(*line).empty() || line->front() == '#') continue;
      auto fields = csv_fields(trimmed(*line));
      if (columns_.empty()) {
        for (std::size_t i = 0; i < fields.size(); ++i) columns_[fields[i]] = i;
        continue;
      }
      if (fields.size() != columns_.size()) fail(lines.line(), "not as many fields as the header");
      rows_.push_back({lines.line(), std::move(fields)});
    }
    if (rows_.empty()) throw ConfigError(path_ + ": has no rows");
  }

  std::size_t size() const { return rows_.size(); }
  bool has(const std::string& column) const { return columns_.contains(column); }
  const std::string& text(std::size_t row, const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end()) fail(rows_[row].line, "there is no column " + column);
    return rows_[row].fields[found->second];
  }
  double number(std::size_t row, const std::string& column, double least, double most) const {
    const auto value = parse_real(text(row, column));
    if (!value || !(*value >= least && *value <= most))
      fail(rows_[row].line, column + formatted(": must be a number in [%g, %g]", least, most) +
                                got(text(row, column)));
    return *value;
  }
  Utc time(std::size_t row, const std::string& column) const {
    const std::string& said = text(row, column);
    try {
      return parse_utc(said);
    } catch (const ConfigError& error) {
      fail(rows_[row].line, column + ": " + error.what());
    }
  }

 private:
  struct Row {
    int line;
    std::vector<std::string> fields;
  };
  [[noreturn]] void fail(int line, const std::string& reason) const {
    throw ConfigError(at_line(path_, line, reason));
  }
  std::string path_, text_;
  std::map<std::string, std::size_t> columns_;
  std::vector<Row> rows_;
};

double sunlit_at(const AttitudeScene& scene, const EarthOrientation& earth) {
  return EarthShadow(scene.sun_m, oblate_earth(earth)).sunlit_fraction(scene.position_m);
}

/// Distance along a direction from a site to a height over the ellipsoid [m], by a sphere through
/// the site: within 0.1 % at these heights.
double range_to_height_m(const Vec<Itrs>& site_m, const Vec<Itrs>& direction, double site_height_m,
                         double height_m) {
  const double here_m = norm(site_m), there_m = here_m - site_height_m + height_m;
  const double up = dot(site_m, direction);
  return -up + std::sqrt(up * up + there_m * there_m - here_m * here_m);
}

/// One row of a light curve.
struct CurvePoint {
  SimTime time;
  double mag = 0.0, range_m = 0.0, phase_rad = 0.0;
  bool penumbra = false;
  std::uint32_t object = 0;
};

/// Adds a pass to the set, or counts its points as left out.
void add_pass(const std::vector<CurvePoint>& points, const Clock& clock, double inclination_rad,
              double height_m, ObservedSet& set) {
  const SimTime middle = points[points.size() / 2].time;
  const EarthOrientation earth = earth_orientation(clock, middle, Nutation::iau2000b);
  const Vec<Gcrs> sun_m = solar_system(clock.tt(middle)).sun_m;
  const Vec<Itrs> site_m = itrs_from_geodetic(mmt_9);
  const auto observer_m = [&](SimTime t) { return earth.itrs_from_gcrs(t).inverse() * site_m; };
  std::vector<RangePhase> seen;
  const std::size_t count = std::min(points_of_fit, points.size());
  for (std::size_t k = 0; k < count; ++k) {
    const auto& p = points[count > 1 ? k * (points.size() - 1) / (count - 1) : 0];
    seen.push_back({(p.time - middle).seconds(), p.range_m, p.phase_rad,
                    earth.cirs_from_gcrs * observer_m(p.time)});
  }
  std::optional<CircularPass> pass;
  try {
    pass = fit_circular_pass(seen, unit(earth.cirs_from_gcrs * sun_m), inclination_rad, height_m);
  } catch (const Error&) {
    set.left_out += points.size();
    return;
  }
  const auto gcrs_from_cirs = earth.cirs_from_gcrs.inverse();
  for (const auto& p : points) {
    const auto state = pass->at((p.time - middle).seconds());
    ObservedLight light{.track = set.tracks,
                        .object = p.object,
                        .measured_mag = p.mag,
                        .scene = {.time_s = p.time.seconds(),
                                  .position_m = gcrs_from_cirs * state.position_m,
                                  .velocity_m_per_s = gcrs_from_cirs * state.velocity_m_per_s,
                                  .sun_m = sun_m},
                        .observer_m = observer_m(p.time)};
    light.sunlit = sunlit_at(light.scene, earth);
    if (p.penumbra || light.sunlit < 1.0)
      ++set.left_out;
    else
      set.lights.push_back(light);
  }
  set.worst_rms_m = std::max(set.worst_rms_m, pass->rms_m);
  ++set.tracks;
}

}  // namespace

ObservedSet read_exposures(const std::string& path) {
  const Table table(path);
  ObservedSet set{.file = path, .system = MagnitudeSystem::ab};
  const Clock clock(table.time(0, "observation_time"));
  const Vec<Itrs> site_m = itrs_from_geodetic(mount_lemmon);
  const auto itrs_from_enu = enu_from_itrs(mount_lemmon).inverse();
  std::vector<std::pair<SimTime, std::size_t>> rows;  // in order of time, which files need not have
  for (std::size_t i = 0; i < table.size(); ++i)
    rows.emplace_back(clock.sim_time(table.time(i, "observation_time")), i);
  std::ranges::sort(rows);
  std::string night;
  for (const auto& [t, i] : rows) {
    const EarthOrientation earth = earth_orientation(clock, t, Nutation::iau2000b);
    const auto gcrs_from_itrs = earth.itrs_from_gcrs(t).inverse();
    const double height_m = 1e3 * table.number(i, "satellite_height", min_km, max_km);
    const double elevation_rad = deg * table.number(i, "satellite_altitude", 0.0, 90.0);
    const double azimuth_rad = deg * table.number(i, "satellite_azimuth", -360.0, 360.0);
    const Vec<Itrs> line = itrs_from_enu * Vec<Enu>{std::sin(azimuth_rad) * std::cos(elevation_rad),
                                                    std::cos(azimuth_rad) * std::cos(elevation_rad),
                                                    std::sin(elevation_rad)};
    const Vec<Itrs> place_m =
        site_m + line * range_to_height_m(site_m, line, mount_lemmon.height_m, height_m);
    const std::string date = table.text(i, "observation_time").substr(0, 10);
    if (date != night) ++set.tracks;
    night = date;
    const Vec<Gcrs> position_m = gcrs_from_itrs * place_m;
    // The way of its flight is not told, and the attitude law does not ask for it: eastwards.
    const double speed = std::sqrt(earth_gm_m3_per_s2 / norm(position_m));
    ObservedLight light{
        .track = set.tracks - 1,
        .measured_mag = table.number(i, "ab_magnitude", brightest_mag, faintest_mag),
        .scene = {.time_s = t.seconds(),
                  .position_m = position_m,
                  .velocity_m_per_s = unit(cross(Vec<Gcrs>{0, 0, 1}, position_m)) * speed,
                  .sun_m = solar_system(clock.tt(t)).sun_m},
        .observer_m = gcrs_from_itrs * site_m};
    light.sunlit = sunlit_at(light.scene, earth);
    if (light.sunlit < 0.5)
      ++set.left_out;
    else
      set.lights.push_back(light);
  }
  return set;
}

ObservedSet read_light_curves(const std::string& path, double inclination_rad, double height_m) {
  const Table table(path);
  ObservedSet set{.file = path, .system = MagnitudeSystem::vega};
  const Clock clock(table.time(0, "Date"));
  std::map<std::string, std::vector<CurvePoint>> curves;
  for (std::size_t i = 0; i < table.size(); ++i)
    curves[table.text(i, "Track")].push_back(
        {.time = clock.sim_time(table.time(i, "Date")),
         .mag = table.number(i, "Mag", brightest_mag, faintest_mag),
         .range_m = 1e3 * table.number(i, "Distance", min_km, max_km),
         .phase_rad = deg * table.number(i, "Phase", 0.0, 180.0),
         .penumbra = table.number(i, "Penumbra", 0.0, 1.0) != 0.0,
         .object = table.has("MMTSat") ? std::uint32_t(table.number(i, "MMTSat", 0.0, 1e9)) : 0u});
  std::vector<std::vector<CurvePoint>> in_time;
  for (auto& [track, points] : curves) {
    std::ranges::stable_sort(points, {}, &CurvePoint::time);
    in_time.push_back(std::move(points));
  }
  std::ranges::stable_sort(in_time, {}, [](const auto& points) { return points.front().time; });
  for (const auto& points : in_time) add_pass(points, clock, inclination_rad, height_m, set);
  return set;
}

}  // namespace dmise
