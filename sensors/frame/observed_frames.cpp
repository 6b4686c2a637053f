#include "sensors/frame/observed_frames.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/detection/own_sightings.h"
#include "core/frames/geodesy.h"
#include "core/orbit/motion.h"

namespace dmise {
namespace {

/// States of all objects at `t`; those without one have the code of none.
ObjectStates states_at(const StateWindow& window, SimTime t) {
  const std::size_t n = window.object_count();
  ObjectStates states{.time = t,
                      .count = n,
                      .position_m = std::vector<double>(3 * n),
                      .slope_m_per_s = std::vector<double>(3 * n),
                      .velocity_m_per_s = std::vector<double>(3 * n),
                      .code = std::vector<std::uint8_t>(n)};
  const auto put = [n](std::vector<double>& rows, std::size_t i, const Vec<Gcrs>& v) {
    rows[i] = v.x, rows[n + i] = v.y, rows[2 * n + i] = v.z;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (!window.has_state(i, t)) {
      states.code[i] = std::uint8_t(MotionCode::untold);
      continue;
    }
    const Motion motion = window.motion(i, t);
    put(states.position_m, i, motion.position_m);
    put(states.slope_m_per_s, i, motion.slope_m_per_s);
    put(states.velocity_m_per_s, i, motion.slope_m_per_s);
  }
  return states;
}

ObserverState observer_at(const SensorConfig& sensor, std::optional<std::size_t> platform,
                          const StateWindow& window, const EarthOrientation& earth, SimTime t) {
  if (platform) {
    const Motion motion = window.motion(*platform, t);
    return {motion.position_m, motion.slope_m_per_s};
  }
  return standing_at(itrs_from_geodetic(*site_of(sensor)), earth, t);
}

}  // namespace

ObservedFrames::ObservedFrames(const PipelineSettings& settings)
    : sensor_(settings.sensor), observer_(settings.observer) {}

std::optional<std::size_t> ObservedFrames::platform(const FrameTimes& exposure,
                                                    const StateWindow& window) const {
  const auto* platform = std::get_if<PlatformConfig>(&sensor_.place);
  if (!platform) return std::nullopt;
  const std::size_t object =
      object_index(window.roster(), platform->object, sensor_.name + ": platform");
  for (const SimTime t : {exposure.start, exposure.middle, exposure.end})
    if (!window.has_state(object, t))
      throw Error(sensor_.name + ": " + window.roster().objects[object].name +
                  " has no state at frame " + std::to_string(exposure.frame) + ": " +
                  window.why_no_state(object, t));
  return object;
}

ObserverExposure ObservedFrames::exposure_of(const FrameTimes& exposure,
                                             const StateWindow& window) const {
  ObserverExposure told{.frame = exposure.frame,
                        .start = exposure.start,
                        .middle = exposure.middle,
                        .end = exposure.end,
                        .environment = window.environment(exposure.middle)};
  told.environment.earth_beside.reset();  // it belongs to another time
  const ObserverState at = observer_at(sensor_, platform(exposure, window), window,
                                       told.environment.earth, exposure.middle);
  told.position_m = at.position_m;
  told.velocity_m_per_s = at.velocity_m_per_s;
  if (!sensor_.observing->truth) return told;
  told.roster = &window.roster();
  told.objects = states_at(window, exposure.middle);
  return told;
}

FrameReport ObservedFrames::report_of(const FrameTimes& exposure, const ObserverExposure& told,
                                      const Observed& observed) const {
  return {.sensor = sensor_.name,
          .frame = exposure.frame,
          .start = exposure.start,
          .middle = exposure.middle,
          .end = exposure.end,
          .boresight_ra_rad = right_ascension_rad(observed.boresight_ra_rad),
          .boresight_dec_rad = observed.boresight_dec_rad,
          .wcs = wcs_without_image(observed.boresight_ra_rad, observed.boresight_dec_rad),
          .sensor_position_m = told.position_m,
          .sensor_velocity_m_per_s = told.velocity_m_per_s,
          .limiting_magnitude = observed.limiting_magnitude.value_or(0.0),
          .detections = std::uint32_t(observed.sightings.size())};
}

FrameProducts ObservedFrames::run(const FrameTimes& exposure, const StateWindow& window,
                                  StatesInField*) {
  double total_s = 0.0;
  FrameProducts frame;
  {
    Stopwatch timing(total_s);
    frame = make(exposure, window);
  }
  frame.total_s = total_s;
  return frame;
}

FrameProducts ObservedFrames::make(const FrameTimes& exposure, const StateWindow& window) const {
  if (!observer_) throw ConfigError(sensor_.observing->where + ": this command starts no programs");
  const ObserverExposure told = exposure_of(exposure, window);
  auto got = observer_(told);
  if (!got) return {.stopped = true};
  if (auto* before = std::get_if<ObservedBefore>(&*got))
    return {.report = std::move(before->report), .detections = std::move(before->detections)};
  return products_of(exposure, window, told, std::get<Observed>(std::move(*got)));
}

FrameProducts ObservedFrames::products_of(const FrameTimes& exposure, const StateWindow& window,
                                          const ObserverExposure& told, Observed observed) const {
  FrameProducts frame;
  std::ranges::stable_sort(observed.sightings, std::ranges::greater(), &OwnSighting::snr);
  frame.report = report_of(exposure, told, observed);
  const auto object = platform(exposure, window);
  for (const OwnSighting& sighting : observed.sightings) {
    const ObserverState at =
        observer_at(sensor_, object, window, told.environment.earth, sighting.time);
    Detection& d = frame.detections.emplace_back(
        detection_of(sighting, frame.report, at.position_m, at.velocity_m_per_s));
    d.index = std::uint32_t(frame.detections.size() - 1);
    d.id = d.sensor + "/" + std::to_string(d.frame) + "/" + std::to_string(d.index);
  }
  return frame;
}

}  // namespace dmise
