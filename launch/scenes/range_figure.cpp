#include "launch/scenes/range_figure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/orbit/sgp4/catalogue_report.h"
#include "core/time/iso8601.h"
#include "sensors/forecast/camera_figures.h"

namespace dmise {
namespace {

constexpr double night_rad = -6.0 * deg;  // end of civil twilight

// Colour-blind safe colours (Okabe and Ito).
struct Kind {
  OrbitRegime regime;
  const char* name;
  Colour colour;
};
constexpr Kind kinds[] = {{OrbitRegime::low, "LEO", {0, 114, 178}},
                          {OrbitRegime::highly_elliptic, "HEO, e >= 0.25", {230, 159, 0}},
                          {OrbitRegime::medium, "MEO", {0, 158, 115}},
                          {OrbitRegime::geosynchronous, "GEO", {213, 94, 0}},
                          {OrbitRegime::beyond, "beyond GEO", {120, 94, 160}}};

std::vector<ChartBand> night_bands(const std::vector<double>& sun_rad, double below_rad,
                                   const TimeGrid& grid) {
  std::vector<ChartBand> bands;
  bool night = false;
  for (std::size_t k = 0; k < sun_rad.size(); ++k) {
    const double hours = (grid.at(k) - grid.from).seconds() / 3600.0;
    const bool now = sun_rad[k] < below_rad;
    if (now && !night) bands.push_back({hours, hours});
    if (now) bands.back().to = hours;
    night = now;
  }
  return bands;
}

/// Full hours (or minutes, for short spans) of UTC as hours since the start.
std::vector<ChartTick> time_ticks(const Clock& clock, const TimeGrid& grid) {
  const double span_s = (grid.last() - grid.from).seconds();
  constexpr double steps_s[] = {1,    2,    5,    10,    30,    60,    120,   300,    600,
                                1800, 3600, 7200, 10800, 21600, 43200, 86400, 172800, 604800};
  double step_s = steps_s[std::size(steps_s) - 1];
  for (const double s : steps_s)
    if (span_s / s <= 12.5) {
      step_s = s;
      break;
    }
  const double of_day_s = double(to_instant(clock.utc(grid.from)).ns_of_day) / double(ns_per_s);
  std::vector<ChartTick> ticks;
  for (double s = std::ceil(of_day_s / step_s - 1e-9) * step_s; s <= of_day_s + span_s + 1e-6;
       s += step_s) {
    const SimTime t = grid.from + sim_seconds(s - of_day_s + 1e-3);
    const std::string utc = format_utc(clock.utc(t), 0);
    ticks.push_back({(s - of_day_s) / 3600.0, step_s < 60      ? utc.substr(11, 8)
                                              : step_s < 86400 ? utc.substr(11, 5)
                                                               : utc.substr(5, 5)});
  }
  return ticks;
}

std::string where(const SensorTrack& track) {
  const auto& site = track.site();
  if (!site) return "aboard " + std::get<PlatformConfig>(track.sensor().place).object;
  return formatted("%.3f deg %c, %.3f deg %c", std::abs(site->latitude_deg),
                   site->latitude_deg < 0 ? 'S' : 'N', std::abs(site->longitude_deg),
                   site->longitude_deg < 0 ? 'W' : 'E');
}

std::string field(const Optics& optics) {
  const CameraFigures figures = camera_figures(optics);
  return formatted("field %.4g x %.4g deg", figures.width_rad / deg, figures.height_rad / deg);
}

}  // namespace

std::vector<double> sun_elevations_rad(const SensorTrack& track, const TimeGrid& grid) {
  std::vector<double> elevations;
  if (!track.site()) return elevations;
  elevations.reserve(grid.steps + 1);
  for (std::size_t k = 0; k <= grid.steps; ++k) {
    const CameraMoment now = track.at(grid.at(k));
    const Sunlight light(track.sky(), now.time);
    const Vec<Gcrs> line = light.sun_m() - light.gcrs_from_teme() * now.apex_m;
    const double sine = dot(light.gcrs_from_teme() * now.up, unit(line));
    elevations.push_back(std::asin(std::clamp(sine, -1.0, 1.0)));
  }
  return elevations;
}

Chart range_figure(const SensorTrack& track, const TimeGrid& grid,
                   const std::vector<MeanElements>& elements, const Sightings& sightings,
                   const RangeFigureOptions& options) {
  const Clock& clock = track.sky().clock();
  const std::vector<double> sun_rad = sun_elevations_rad(track, grid);
  const double below_rad = options.night_below_rad.value_or(night_rad);

  constexpr std::size_t kind_count = std::size(kinds);
  std::array<ChartSeries, kind_count> series;
  std::array<std::size_t, kind_count> objects{};
  std::array<std::uint32_t, kind_count> last_object;
  last_object.fill(std::uint32_t(-1));
  double nearest_km = 1e300, farthest_km = 0.0;
  const Sighting* before = nullptr;  // drawn last
  for (const Sighting& s : sightings.seen) {
    if ((s.sunlit >= lit_fraction) == options.dark) continue;
    if (options.night_below_rad && !sun_rad.empty() && !(sun_rad[s.step] < below_rad)) continue;
    std::size_t k = 0;
    while (kinds[k].regime != regime_of(elements[s.object])) ++k;
    if (last_object[k] != s.object) ++objects[k];
    last_object[k] = s.object;
    if (!before || before->object != s.object || before->step + 1 != s.step)
      series[k].lines.emplace_back();
    const double km = s.range_m / 1e3;
    series[k].lines.back().push_back({(grid.at(s.step) - grid.from).seconds() / 3600.0, km});
    nearest_km = std::min(nearest_km, km);
    farthest_km = std::max(farthest_km, km);
    before = &s;
  }

  Chart chart;
  chart.title = std::string("Objects in the field of ") + track.sensor().name +
                (options.dark ? " and in the Earth's shadow" : " and sunlit");
  const std::string start = format_utc(clock.utc(grid.from), 0);
  chart.subtitle =
      where(track) + "; " + field(track.sensor().camera.optics) + "; catalogue of " +
      formatted("%zu objects, every %g s; (n): number drawn", elements.size(), grid.step.seconds());
  chart.x = {.label = "Time [UTC], from " + start,
             .least = 0.0,
             .most = std::max((grid.last() - grid.from).seconds(), 1e-3) / 3600.0,
             .ticks = time_ticks(clock, grid)};
  double least_km = 200.0, most_km = 50000.0;
  if (farthest_km > 0.0) {
    least_km = std::max(1e-3, nearest_km / 1.2);
    most_km = std::max(farthest_km * 1.2, least_km * 3.0);
  }
  chart.y = logarithmic_axis("Range [km]", least_km, most_km);
  for (std::size_t k = 0; k < kind_count; ++k) {
    if (series[k].lines.empty()) continue;
    series[k].label = std::string(kinds[k].name) + " (" + std::to_string(objects[k]) + ")";
    series[k].colour = kinds[k].colour;
    chart.series.push_back(std::move(series[k]));
  }
  chart.bands = night_bands(sun_rad, below_rad, grid);
  if (!chart.bands.empty())
    chart.bands_label = formatted("Sun below %.3g deg at the site", below_rad / deg);
  return chart;
}

}  // namespace dmise
