#include "tests/support/fusion_trial.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/frames/earth_orientation.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/sky/places/sun_moon.h"

namespace dmise {
namespace {

constexpr double min_elevation_sine = 0.17;

}  // namespace

FusionTrial::FusionTrial(std::vector<MeanElements> objects, const Clock& clock,
                         const FusionTrialSettings& settings)
    : objects_(std::move(objects)),
      clock_(clock),
      settings_(settings),
      paths_(objects_, clock, {}) {}

void FusionTrial::move(SimTime time) {
  if (moved_ && paths_.time() == time) return;
  moved_ = true;
  paths_.move(time);
  const EarthOrientation earth = earth_orientation(clock_, time);
  gcrs_from_itrs_ = earth.itrs_from_gcrs(time).inverse();
  sun_m_ = solar_system(clock_.tt(time)).sun_m;
  shadow_.emplace(sun_m_, oblate_earth(earth));
  lit_.assign(objects_.size(), -1.0);
}

std::vector<SensorFrame> FusionTrial::frames(SimTime time, std::uint32_t number) {
  move(time);
  std::vector<SensorFrame> out;
  for (std::size_t k = 0; k < settings_.sites.size(); ++k) {
    const TrialSensor sensor{.name = "site" + std::to_string(100 + k),
                             .site = settings_.sites[k],
                             .half_angle_rad = settings_.half_angle_rad,
                             .sigma_rad = settings_.sigma_rad,
                             .limiting_magnitude = settings_.limiting_magnitude,
                             .first_object = k * 1009};
    out.push_back(
        frame_of(sensor, unit(gcrs_from_itrs_ * itrs_from_geodetic(sensor.site)), time, number));
  }
  return out;
}

SensorFrame FusionTrial::frame_of(const TrialSensor& sensor, const Vec<Gcrs>& axis, SimTime time,
                                  std::uint32_t number) {
  move(time);
  const std::string& name = sensor.name;
  const RngKey key = rng_key(settings_.seed, name, number, "trial");
  SensorFrame frame{.sensor = name,
                    .frame = number,
                    .time = time,
                    .sensor_m = gcrs_from_itrs_ * itrs_from_geodetic(sensor.site),
                    .axis = axis,
                    .half_angle_rad = sensor.half_angle_rad,
                    .limiting_magnitude = sensor.limiting_magnitude};
  const Vec<Gcrs> up = unit(frame.sensor_m);
  const auto add = [&](const Vec<Gcrs>& direction, double magnitude, std::uint32_t object,
                       std::uint32_t draw) {
    const SkyTangents tangents = sky_tangents(direction);
    SeenSource source;
    AngleObservation& seen = source.observation;
    seen.time = time;
    seen.sensor_m = frame.sensor_m;
    seen.direction =
        unit(direction + sensor.sigma_rad * normal_of(rng_word(key, draw, 1)) * tangents.east +
             sensor.sigma_rad * normal_of(rng_word(key, draw, 2)) * tangents.north);
    const double variance = sensor.sigma_rad * sensor.sigma_rad;
    seen.covariance_rad2 = {variance, 0, variance};
    seen.sensor = name;
    seen.detection_id =
        name + "/" + std::to_string(number) + "/" + std::to_string(frame.sources.size());
    source.magnitude = magnitude;
    truth_[seen.detection_id] = object;
    frame.sources.push_back(std::move(source));
  };
  const double cos_field = std::cos(sensor.half_angle_rad);
  for (std::size_t n = 0; n < objects_.size(); ++n) {
    // Sites that see more than they may tell do not all tell of the same.
    const std::size_t i = (n + sensor.first_object) % objects_.size();
    if (!paths_.known(i) || frame.sources.size() >= settings_.max_per_frame) continue;
    const Vec<Gcrs> r = paths_.position_m(i);
    Vec<Gcrs> line = r - frame.sensor_m;
    const double range = norm(line);
    if (dot(line, up) < min_elevation_sine * range || dot(line, axis) < cos_field * range) continue;
    if (lit_[i] < 0) lit_[i] = shadow_->sunlit_fraction(r);
    if (lit_[i] < 0.5) continue;
    line = line - paths_.velocity_m_per_s(i) * (norm(line) / speed_of_light_m_per_s);
    const double range_m = norm(line);
    const double standard =
        3 + 6 * uniform_of(rng_word(rng_key(7, "brightness", 0, "trial"), std::uint32_t(i), 0));
    const double magnitude = magnitude_from_standard(
        {.v_mag = standard}, {.range_m = range_m, .phase_rad = angle_rad(sun_m_ - r, -line)});
    if (magnitude > sensor.limiting_magnitude ||
        uniform_of(rng_word(key, std::uint32_t(i), 0)) > settings_.detection_probability)
      continue;
    add(line / range_m, magnitude, objects_[i].catalogue_number, std::uint32_t(i));
  }
  double chance = std::exp(-settings_.false_alarms_per_frame), sum = chance;
  const double drawn = uniform_of(rng_word(key, 0xffffffff, 0));
  for (std::uint32_t n = 0; drawn > sum && n < 1000; ++n) {
    const std::uint32_t draw = 0xf0000000 + n;
    const double c = 1 - uniform_of(rng_word(key, draw, 3)) * (1 - cos_field);
    const double turn = 2 * pi * uniform_of(rng_word(key, draw, 4));
    const SkyTangents t = sky_tangents(axis);
    const Vec<Gcrs> across = std::cos(turn) * t.east + std::sin(turn) * t.north;
    add(axis * c + across * std::sqrt(1 - c * c),
        sensor.limiting_magnitude - uniform_of(rng_word(key, draw, 5)), 0, draw);
    chance *= settings_.false_alarms_per_frame / (n + 1);
    sum += chance;
  }
  return frame;
}

std::uint32_t FusionTrial::truth(const std::string& id) const {
  const auto found = truth_.find(id);
  return found == truth_.end() ? 0 : found->second;
}

void TrackLedger::add(const std::vector<Track>& tracks) {
  for (const Track& t : tracks) {
    Entry& entry = entries_[t.id];
    entry.confirmed = entry.confirmed || t.status == TrackStatus::confirmed;
    entry.detections.insert(entry.detections.end(), t.associated.begin(), t.associated.end());
  }
}

TrackingScore TrackLedger::score(const FusionTrial& trial, std::size_t least) const {
  TrackingScore out;
  std::map<std::uint32_t, std::size_t> seen;
  for (const auto& [id, object] : trial.truths())
    if (object) ++seen[object];
  std::map<std::uint32_t, bool> tracked;
  for (const auto& [id, entry] : entries_) {
    if (!entry.confirmed) continue;
    ++out.tracks;
    std::map<std::uint32_t, std::size_t> shares;
    for (const std::string& detection : entry.detections) ++shares[trial.truth(detection)];
    std::pair<std::uint32_t, std::size_t> most{};
    for (const auto& share : shares)
      if (share.second > most.second) most = share;
    out.associated += entry.detections.size();
    if (most.first == 0) {
      ++out.of_noise;
      continue;
    }
    out.pure += most.second;
    tracked[most.first] = true;
  }
  for (const auto& [object, detections] : seen) {
    if (detections < least) continue;
    ++out.objects;
    out.found += tracked.contains(object);
  }
  return out;
}

}  // namespace dmise
