#include "sensors/survey/sensor_survey.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/visibility/sightings.h"

namespace dmise {
namespace {

/// Exposures that are looked at before their looks are taken together.
constexpr std::size_t block = 128;

/// Exposures farther apart than this are searched separately for objects.
constexpr std::int64_t search_gap_ns = 3'600'000'000'000;

/// Steps of the grid, which nothing depends on.
constexpr double grid_step_s = 600.0;

std::optional<double> sun_elevation_rad(const SurveyScene& scene, const SensorConfig& sensor,
                                        SimTime t) {
  const auto site = site_of(sensor);
  if (!site) return std::nullopt;
  const auto itrs_from_gcrs = scene.hours().earth(t).itrs_from_gcrs(t);
  const Vec<Itrs> line = itrs_from_gcrs * scene.hours().sun_m(t) - itrs_from_geodetic(*site);
  const Vec<Enu> enu = enu_from_itrs(*site) * unit(line);
  return std::asin(std::clamp(enu.z, -1.0, 1.0));
}

/// Takes the looks of exposures together, in their order.
class Collector {
 public:
  Collector(SensorSurvey& survey, const Shells& shells)
      : survey_(survey), shells_(shells), open_(shells.of_object.size(), none) {}

  void take(SurveyExposure exposure, const ExposureForecast& seen) {
    exposure.in_field = seen.in_field;
    exposure.sunlit = seen.sunlit;
    survey_.closed += seen.closed;
    for (const ExpectedDetection& look : seen.looks) {
      exposure.expected += look.probability;
      take(look, exposure.middle);
    }
    survey_.exposures.push_back(exposure);
  }

  void finish() {
    std::stable_sort(survey_.passes.begin(), survey_.passes.end(),
                     [](const SurveyPass& a, const SurveyPass& b) { return a.object < b.object; });
  }

 private:
  static constexpr std::uint32_t none = std::uint32_t(-1);

  void take(const ExpectedDetection& look, SimTime t) {
    auto& passes = survey_.passes;
    std::uint32_t& open = open_[look.object];
    if (open == none || (t - passes[open].last).seconds() > pass_gap_s ||
        night_of(t) != night_of(passes[open].last)) {
      open = std::uint32_t(passes.size());
      passes.push_back({.object = look.object, .first = t});
    }
    SurveyPass& pass = passes[open];
    pass.last = t;
    ++pass.exposures;
    pass.expected += look.probability;
    pass.log_miss += std::log1p(-look.probability);
    pass.best_snr = std::max(pass.best_snr, look.snr);
    const double east = std::fmod(look.longitude_rad / pi * 180.0 + 180.0, 360.0);
    const auto index = [](double share, int count) {
      return std::uint16_t(std::clamp(int(share * count), 0, count - 1));
    };
    MapCell& cell =
        survey_.map[{shells_.of_object[look.object], index(0.5 + look.latitude_rad / pi, map_rows),
                     index(east / 360.0, map_columns)}];
    ++cell.looks;
    cell.expected += std::uint64_t(std::llround(look.probability / map_unit));
  }

  SensorSurvey& survey_;
  const Shells& shells_;
  std::vector<std::uint32_t> open_;  // the last pass of an object
};

}  // namespace

int nights_of(SimTime duration) {
  return int(std::max<std::int64_t>(1, (duration.ns + night_ns - 1) / night_ns));
}

std::vector<std::vector<std::uint32_t>> objects_by_frame(const SurveyScene& scene,
                                                         const SensorConfig& sensor,
                                                         const std::vector<std::uint32_t>& frames,
                                                         Threads& threads) {
  std::vector<std::vector<std::uint32_t>> objects(frames.size());
  if (frames.empty()) return objects;
  const auto count = std::uint32_t(scene.population().roster.objects.size());
  const auto with_elements = std::uint32_t(scene.population().elements.size());
  std::optional<std::size_t> platform, target;
  if (const auto* p = std::get_if<PlatformConfig>(&sensor.place))
    platform = object_index(*scene.roster(), p->object, p->where);
  if (const auto* p = std::get_if<PointTarget>(&sensor.pointing))
    target = object_index(*scene.roster(), p->object, p->where);
  const bool follows = (!platform || *platform < with_elements) &&
                       (!target || *target < with_elements) &&
                       !std::holds_alternative<PointBody>(sensor.pointing);
  std::optional<SensorTrack> track;
  if (follows) track.emplace(sensor, scene.hours(), scene.source().elements(), platform, target);
  for (std::size_t first = 0; first < frames.size();) {
    std::size_t end = first + 1;
    const auto span_of = [&](std::size_t k) { return exposure_span(sensor, frames[k]); };
    while (end < frames.size() && (span_of(end).start - span_of(end - 1).end).ns < search_gap_ns)
      ++end;
    const SimTime from = span_of(first).start, to = span_of(end - 1).end;
    std::vector<VisibilityInterval> intervals;
    if (track && with_elements > 0)
      intervals = find_sightings(scene.source().elements(), *track,
                                 covering_grid(from, to - from, sim_seconds(grid_step_s)), threads)
                      .intervals;
    for (const VisibilityInterval& interval : intervals) {
      const auto after =
          std::partition_point(frames.begin() + std::ptrdiff_t(first),
                               frames.begin() + std::ptrdiff_t(end), [&](std::uint32_t frame) {
                                 return exposure_span(sensor, frame).end < interval.out_before;
                               });
      for (auto k = std::size_t(after - frames.begin());
           k < end && span_of(k).start <= interval.out_after; ++k)
        if (objects[k].empty() || objects[k].back() != interval.object)
          objects[k].push_back(interval.object);
    }
    first = end;
  }
  for (auto& of_frame : objects)
    for (std::uint32_t i = follows ? with_elements : 0; i < count; ++i) of_frame.push_back(i);
  return objects;
}

bool is_surveyed(const SurveyScene& scene, const SensorConfig& sensor, std::uint32_t frame,
                 const SurveyOptions& options) {
  const auto sun_rad = sun_elevation_rad(scene, sensor, frame_times(sensor, frame).middle);
  return !sun_rad || *sun_rad < options.night_below_rad;
}

SensorSurvey survey_sensor(const SurveyScene& scene, const SensorConfig& sensor,
                           const Shells& shells, Threads& threads, const SurveyOptions& options) {
  SensorSurvey survey{.sensor = sensor.name,
                      .frames = frames_within(sensor, scene.scenario().duration)};
  const ExposureForecaster looks(scene, sensor);
  std::vector<SurveyExposure> exposures;
  std::vector<std::uint32_t> frames;
  for (std::uint32_t frame = 1; frame <= survey.frames; ++frame) {
    const FrameTimes times = frame_times(sensor, frame);
    const auto sun_rad = sun_elevation_rad(scene, sensor, times.middle);
    if (sun_rad && !(*sun_rad < options.night_below_rad)) continue;
    exposures.push_back({.frame = frame, .middle = times.middle, .sun_elevation_rad = sun_rad});
    frames.push_back(frame);
  }
  const auto objects = objects_by_frame(scene, sensor, frames, threads);
  Collector collector(survey, shells);
  std::vector<std::optional<ExposureForecast>> seen;
  for (std::size_t first = 0; first < frames.size(); first += block) {
    const std::size_t end = std::min(frames.size(), first + block);
    seen.assign(end - first, std::nullopt);
    threads.for_ranges(end - first, 1, [&](std::size_t begin, std::size_t stop) {
      for (std::size_t k = begin; k < stop; ++k)
        seen[k] = looks.of(frame_times(sensor, frames[first + k]), objects[first + k]);
    });
    for (std::size_t k = first; k < end; ++k) {
      if (seen[k - first])
        collector.take(exposures[k], *seen[k - first]);
      else
        ++survey.without_state;
    }
    if (options.progress) options.progress(double(end) / double(frames.size()));
  }
  collector.finish();
  return survey;
}

}  // namespace dmise
