#include "core/fusion/live_track.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

constexpr double max_log_odds = 12.0;  // a long track is given up within a dozen looks, too
constexpr double standard_range_m = 1e6;
constexpr std::size_t max_seen_in = 64;

/// "<sensor>/<frame>" of a detection's "<sensor>/<frame>/<index>".
std::string exposure_of(const std::string& detection_id) {
  return detection_id.substr(0, detection_id.rfind('/'));
}

}  // namespace

double brightness_offset(double range_m) { return 5 * std::log10(range_m / standard_range_m); }

LiveTrack::LiveTrack(std::uint32_t number, OrbitFilter&& start,
                     std::optional<std::size_t> of_catalogue)
    : id(number), filter(std::move(start)), object(of_catalogue), last_seen(filter.time()) {}

double LiveTrack::existence() const { return 1 / (1 + std::exp(-log_odds)); }

void MeanBrightness::add(double magnitude, double range_m) {
  if (magnitude == no_magnitude) return;
  sum += magnitude - brightness_offset(range_m);
  ++count;
}

double MeanBrightness::magnitude(double range_m) const {
  return sum / std::max(1, count) + brightness_offset(range_m);
}

bool LiveTrack::place_roughly(const ForceModel& forces, SimTime time) {
  const OrbitEstimate now = filter.estimate();
  const auto moved = propagate(forces, now.state, time, {.position_tolerance_m = 1.0});
  if (!moved) return false;
  rough = *moved;
  sigma_m = std::sqrt(now.covariance.topLeftCorner<3, 3>().trace());
  sigma_m_per_s = std::sqrt(now.covariance.block<3, 3>(3, 3).trace());
  age_s = std::fabs((time - now.state.time).seconds());
  return true;
}

double LiveTrack::rough_sigma_m(double noise) const {
  return sigma_m + sigma_m_per_s * age_s + std::sqrt(noise * age_s * age_s * age_s);
}

void LiveTrack::count(const AngleObservation& observation, double magnitude_seen,
                      const Vec<Gcrs>& position_m) {
  brightness.add(magnitude_seen, norm(position_m - observation.sensor_m));
  ++detections;
  last_seen = std::max(last_seen, observation.time);
  associated.push_back(observation.detection_id);
  if (arc) arc->push_back(observation);
  if (seen_in.size() == max_seen_in) seen_in.erase(seen_in.begin());
  seen_in.push_back(exposure_of(observation.detection_id));
}

bool LiveTrack::take(const AngleObservation& observation, double magnitude_seen,
                     double detection_probability, double false_per_sr) {
  const auto found = filter.update(observation);
  if (!found) return false;
  const double p = detection_probability;
  log_odds =
      std::min(max_log_odds,
               log_odds + std::log(1 - p + p * std::exp(found->log_likelihood) / false_per_sr));
  innovation_d2 = found->d2;
  count(observation, magnitude_seen, filter.estimate().state.position_m);
  changed = true;
  return true;
}

bool LiveTrack::take_part(const AngleObservation& part) {
  const auto found = filter.update(part);
  if (!found) return false;
  innovation_d2 = found->d2;
  last_seen = std::max(last_seen, part.time);
  changed = true;
  return true;
}

bool LiveTrack::is_seen_beside(const std::string& detection_id) const {
  return std::ranges::find(seen_in, exposure_of(detection_id)) != seen_in.end();
}

void LiveTrack::miss(double detection_probability) {
  log_odds = std::max(-max_log_odds, log_odds + std::log1p(-detection_probability));
}

Track published(const LiveTrack& track, SimTime time) {
  const auto moved = track.filter.estimate_at(time);
  const OrbitEstimate now = moved ? *moved : track.filter.estimate();
  Track out{.id = track.id,
            .status = track.status,
            .time = time,
            .position_m = now.state.position_m,
            .velocity_m_per_s = now.state.velocity_m_per_s,
            .covariance = lower_triangle<6>(now.covariance),
            .drag_m2_per_kg = now.state.drag_m2_per_kg,
            .drag_sigma_m2_per_kg = std::sqrt(now.covariance(drag_row, drag_row)),
            .srp_m2_per_kg = now.state.srp_m2_per_kg,
            .srp_sigma_m2_per_kg = std::sqrt(now.covariance(srp_row, srp_row)),
            .existence = track.existence(),
            .detections = std::uint32_t(track.detections),
            .associated = track.associated,
            .innovation_d2 = track.innovation_d2,
            .last_seen = track.last_seen};
  if (track.brightness.is_known()) out.magnitude = track.magnitude(standard_range_m);
  return out;
}

}  // namespace dmise
