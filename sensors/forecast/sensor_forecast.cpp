#include "sensors/forecast/sensor_forecast.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/effects/frame_effects.h"
#include "sensors/forecast/forecast_text.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/objects/state_window_source.h"
#include "sensors/planning/exposure_planner.h"

namespace dmise {
namespace {

constexpr std::uint32_t max_frames_with_states = 2000;  // for a platform or a target

/// The first examined frame at which an object needed by the sensor has no state.
struct Loss {
  std::uint32_t frame = 0;
  std::string why;
};
std::optional<Loss> first_loss(const Scenario& scenario, const SensorConfig& sensor,
                               const ObjectPopulation& needed, const StateSource& source,
                               std::uint32_t frames) {
  if (needed.roster.objects.empty()) return std::nullopt;
  for (const std::uint32_t frame : evenly(frames, max_frames_with_states)) {
    const ExposureSpan exposure = exposure_span(sensor, frame);
    for (const Tick tick : {exposure.start.ns / scenario.tick.ns,
                            (exposure.end.ns + scenario.tick.ns - 1) / scenario.tick.ns}) {
      const Tick within = std::min<Tick>(tick, scenario.last_tick());
      const ObjectStates states = source.at(within, scenario.time_of(within));
      for (std::size_t i = 0; i < states.count; ++i)
        if (states.code[i] != 0) return Loss{frame, source.why_absent(i, states)};
    }
  }
  return std::nullopt;
}

/// The node that moves or turns one of these objects; empty: none does.
std::string node_of(const ObjectPopulation& objects) {
  for (const MotionModel& model : objects.models)
    if (const auto* by_node = std::get_if<NodeMotion>(&model)) return by_node->node;
  for (const ObjectAttitude& attitude : objects.attitudes)
    if (const auto* by_node = std::get_if<NodeAttitude>(&attitude.model)) return by_node->node;
  return "";
}

/// Examines all frames, or evenly spaced ones, for bodies that are too near to the axis.
void look_for_exclusion(const Scenario& scenario, const SensorConfig& sensor,
                        const ObjectPopulation& needed, const StateSource& source,
                        std::uint32_t frames, const StateWindowSource& windows,
                        SensorForecast& out) {
  const Exclusion& limits = sensor.camera.exclusion;
  for (const ExcludingBody& body : excluding_bodies)
    if (const auto& limit_deg = limits.*body.limit_deg)
      out.excluded.push_back({.body = &body, .limit_deg = *limit_deg});
  for (const std::uint32_t frame : evenly(frames, max_frames_with_states)) {
    const FrameTimes exposure = frame_times(sensor, frame);
    const StateWindow window = windows.around(exposure, needed, source);
    const View view(sensor, exposure, window, scenario.seed);
    const BodyAngles angles = body_angles(view);
    const Excluded in_force = excluded_by(limits, angles);
    ++out.looked_for_exclusion;
    out.excluded_frames += in_force.any();
    for (ExcludedFrames& of : out.excluded) {
      if (const auto& angle = angles.*of.body->angle_rad)
        of.min_rad = std::min(of.min_rad.value_or(*angle), *angle);
      if (!(in_force.*of.body->excluded)) continue;
      if (of.count++ == 0) {
        of.first = frame;
        of.first_middle = exposure.middle;
      }
      of.last = frame;
      of.last_middle = exposure.middle;
    }
  }
}

}  // namespace

SensorForecast sensor_forecast(const Scenario& scenario, const SensorConfig& sensor,
                               const ObjectPopulation& population, const Clock& clock,
                               std::shared_ptr<const StarMap> stars, Threads& threads,
                               const ForecastOptions& options) {
  SensorForecast out{.sensor = sensor.name,
                     .camera = camera_figures(sensor.camera.optics),
                     .on_ground = std::holds_alternative<SiteConfig>(sensor.place),
                     .frames_in_run = frames_within(sensor, scenario.duration)};
  if (const auto* target = std::get_if<PointTarget>(&sensor.pointing)) out.target = target->object;
  out.cued = std::holds_alternative<PointCued>(sensor.pointing);
  out.min_limb_angle_rad = options.min_limb_angle_rad;
  const auto needed = only_these(population, needed_objects(sensor, population.roster));
  out.by_node = node_of(needed);
  if (!out.by_node.empty()) return out;
  const StateSource source_of_needed(needed, clock, threads);
  const auto loss = first_loss(scenario, sensor, needed, source_of_needed, out.frames_in_run);
  if (loss && loss->frame == 1) throw ConfigError(sensor.where + ": " + loss->why);
  const std::uint32_t frames = loss ? loss->frame - 1 : out.frames_in_run;

  const StateWindowSource windows(scenario, sensor, clock, close_environments_s);
  if (options.max_frames > 0 && sensor.camera.exclusion.any()) {
    out.exclusion_action = sensor.camera.exclusion.action;
    look_for_exclusion(scenario, sensor, needed, source_of_needed, frames, windows, out);
  }
  std::uint32_t looks = options.max_frames;
  if (looks == 0) {
    out.objects_counted = false;
  } else if (frames > 0 && sensor.effects.has(SpaceObjects::facts) &&
             !population.roster.objects.empty()) {
    const auto ticks = windows.ticks_of(frame_times(sensor, 1));
    const std::size_t states =
        3 * std::size_t(ticks.last - ticks.first + 1) * population.roster.objects.size();
    if (options.max_states / states < 2)
      out.objects_counted = false;
    else
      looks = std::uint32_t(std::min<std::size_t>(looks, options.max_states / states));
  }
  const ObjectPopulation& seen = out.objects_counted ? population : needed;
  const StateSource source(seen, clock, threads);
  const ObjectShapes shapes(scenario.own_objects, sensor.camera.band, sensor.effects,
                            models_of(scenario.objects));
  const ExposurePlanner planner(sensor, stars.get(), scenario.faintest_star_mag, &shapes);
  const ForecastScene scene{.stars = std::move(stars),
                            .faintest_star_mag = scenario.faintest_star_mag,
                            .shapes = &shapes,
                            .planner = &planner,
                            .psf_sigma_px = blur_sigma_px(sensor),
                            .count_objects = out.objects_counted};
  const auto look_at = [&](std::uint32_t frame, const ForecastScene& with) {
    const FrameTimes exposure = frame_times(sensor, frame);
    const StateWindow window = windows.around(exposure, seen, source);
    return frame_forecast(View(sensor, exposure, window, scenario.seed), with);
  };
  for (const std::uint32_t frame : evenly(frames, looks))
    out.frames.push_back(look_at(frame, scene));
  ForecastScene without_objects = scene;
  without_objects.count_objects = false;
  if (frames > 0) out.mid_run = look_at((frames + 1) / 2, without_objects);
  out.warnings = warnings_of(out, sensor.where.empty() ? sensor.name : sensor.where);
  if (loss)
    out.warnings.push_back(sensor.where + ": the run ends in an error at frame " +
                           std::to_string(loss->frame) + " at the latest: " + loss->why);
  return out;
}

std::vector<std::string> catalogue_warnings(const Scenario& scenario,
                                            const ObjectPopulation& population) {
  std::vector<double> age_days;
  for (std::size_t i = 0; i < population.elements.size(); ++i)
    age_days.push_back(std::abs(population.roster.objects[i].element_age_s) / day_s);
  if (age_days.empty()) return {};
  const double middle = middle_of(age_days);
  if (middle < old_after_days) return {};
  const std::string where = scenario.objects.empty() ? scenario.path : scenario.objects[0].where;
  const char* error = middle < 60.0    ? "positions are off by kilometres to tens of kilometres"
                      : middle < 365.0 ? "positions are off by hundreds of kilometres"
                                       : "places along the orbits are not known";
  return {where + formatted(": half of the %zu element sets are %.0f days or more from the start "
                            "of the run: %s",
                            population.elements.size(), middle, error)};
}

}  // namespace dmise
