#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/units.h"
#include "core/fusion/blended_pair.h"
#include "core/fusion/frame_pairs.h"
#include "core/fusion/fusion_scene.h"
#include "core/fusion/sky_cells.h"
#include "core/tracking/line_of_light.h"

namespace dmise {
namespace {

constexpr double coarse_sigmas = 5.0;       // reach of the coarse search
constexpr double largest_radius_rad = 0.2;  // tracks that are known worse are not looked for
constexpr double min_radius_rad = 1e-4;
constexpr double earth_m = 6.35e6;
const double burn_price = -2 * std::log(1e-3);  // probability of a manoeuvre since the last arc
constexpr double edge_px = 4.0;                 // within which a source may be missed
constexpr double least_looked = 0.05;           // probability of detection that makes a look
constexpr double certain_sigma_rad = 0.01;      // places known better than this can be missed
constexpr double blend_reach = 1.5;             // resolutions, within which a blend is one source

bool behind_earth(const Vec<Gcrs>& sensor_m, const Vec<Gcrs>& direction, double range_m) {
  const double along = -dot(sensor_m, direction);
  if (along <= 0 || along >= range_m) return false;
  return norm(sensor_m + direction * along) < earth_m;
}

/// The source within an angle of a direction, if it is there alone.
std::optional<std::size_t> only_source(const SensorFrame& frame, const Vec<Gcrs>& direction,
                                       double within_rad) {
  std::optional<std::size_t> only;
  for (std::size_t row = 0; row < frame.sources.size(); ++row) {
    if (angle_rad(frame.sources[row].observation.direction, direction) > within_rad) continue;
    if (only) return std::nullopt;
    only = row;
  }
  return only;
}

}  // namespace

std::vector<Fusion::Candidate> Fusion::candidates(Scene& scene, const SensorFrame& frame,
                                                  std::span<const std::uint64_t> inside) const {
  std::vector<Candidate> out;
  const double dt_s = (frame.time - scene.time).seconds();
  double seen_sigma = 0;
  for (const SeenSource& s : frame.sources)
    seen_sigma =
        std::max({seen_sigma, s.observation.covariance_rad2[0], s.observation.covariance_rad2[2]});
  seen_sigma = std::sqrt(seen_sigma);
  const double cos_field = std::cos(std::min(pi, frame.half_angle_rad + largest_radius_rad));
  const auto take = [&](Candidate& candidate, double sigma_rad) {
    candidate.sigma_rad = sigma_rad;
    candidate.radius_rad = coarse_sigmas * (sigma_rad + seen_sigma) + min_radius_rad;
    if (candidate.radius_rad > largest_radius_rad) return false;
    if (!behind_earth(frame.sensor_m, candidate.direction, candidate.range_m))
      out.push_back(candidate);
    return true;
  };
  const auto add = [&](Candidate candidate, const Vec<Gcrs>& r, const Vec<Gcrs>& v,
                       double sigma_m) {
    Vec<Gcrs> line = position_after_m(r, v, dt_s) - frame.sensor_m;
    line = position_after_m(r, v, dt_s - norm(line) / speed_of_light_m_per_s) - frame.sensor_m;
    candidate.range_m = norm(line);
    if (candidate.range_m < 1.0) return;
    candidate.direction = line / candidate.range_m;
    if (dot(candidate.direction, frame.axis) < cos_field) return;
    if (take(candidate, sigma_m / candidate.range_m) || !candidate.track) return;
    // An ellipse that is long along the line of sight may be narrow across.
    const auto seen = candidate.track->filter.predict(frame.time, frame.sensor_m);
    if (!seen) return;
    candidate.direction = seen->direction;
    candidate.range_m = seen->range_m;
    if (dot(candidate.direction, frame.axis) >= cos_field)
      take(candidate, std::sqrt(seen->covariance_rad2.trace()));
  };
  for (LiveTrack* track : scene.placed)
    add({.track = track}, track->rough.position_m, track->rough.velocity_m_per_s,
        track->rough_sigma_m(settings_.acceleration_noise_m2_per_s3));
  for (const auto& [i, place] : scene.kept) {
    if (track_of_[i]) continue;
    const auto& [state, sigma_m, burnt_sigma_m] = place;
    add({.object = i}, state.position_m, state.velocity_m_per_s, sigma_m);
    add({.object = i, .burnt = true}, state.position_m, state.velocity_m_per_s, burnt_sigma_m);
  }
  for (std::size_t word = 0; word < inside.size(); ++word)
    for (std::uint64_t bits = inside[word]; bits != 0; bits &= bits - 1) {
      const std::size_t i = word * 64 + std::size_t(std::countr_zero(bits));
      if (track_of_[i] || scene.is_kept(i)) continue;
      add({.object = i}, catalogue_.position_m(i), catalogue_.velocity_m_per_s(i),
          catalogue_.sigma_m(i));
    }
  return out;
}

PredictedDirection Fusion::predicted(const Candidate& candidate, const SensorFrame& frame,
                                     const AngleObservation& observation) const {
  if (!candidate.track) {
    const auto now = candidate.burnt ? kept_->burnt(candidate.object, observation.time)
                                     : believed(candidate.object, observation.time);
    return now ? predict_direction(*now, frame.sensor_m, observation.time) : PredictedDirection{};
  }
  const auto out = candidate.track->filter.predict(observation.time, frame.sensor_m);
  return out ? *out : PredictedDirection{};  // range 0: no prediction
}

/// The two tracks' parts of the source, if it is more likely the light of both than of either
/// alone.
std::optional<BlendedPair> Fusion::blend_of(const Candidate& a, const Candidate& b,
                                            const SensorFrame& frame,
                                            const AngleObservation& seen) const {
  const auto first = a.track->filter.predict(seen.time, seen.sensor_m),
             second = b.track->filter.predict(seen.time, seen.sensor_m);
  if (!first || !second || angle_rad(first->direction, second->direction) > frame.resolution_rad)
    return std::nullopt;
  const double fainter = a.track->magnitude(a.range_m) - b.track->magnitude(b.range_m);
  BlendedPair blend = blended_pair(seen, *first, *second, 1 / (1 + std::pow(10.0, 0.4 * fainter)));
  const double p = settings_.detection_probability;
  const double alone = std::min(innovation_of(*first, seen).d2, innovation_of(*second, seen).d2);
  if (!(blend.d2 < settings_.gate_d2) || blend.d2 > alone + 2 * std::log(p / (1 - p)))
    return std::nullopt;
  return blend;
}

void Fusion::take_blends(const SensorFrame& frame, std::span<const Candidate> all,
                         std::vector<bool>& found, std::vector<bool>& blended) {
  const double reach_rad = blend_reach * frame.resolution_rad;
  if (!(reach_rad > 0.0)) return;
  std::vector<std::size_t> tracks;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].track && all[k].track->status == TrackStatus::confirmed &&
        all[k].track->brightness.is_known())
      tracks.push_back(k);
  std::ranges::sort(tracks, {}, [&](std::size_t k) { return all[k].direction.z; });
  for (std::size_t i = 0; i < tracks.size(); ++i)
    for (std::size_t j = i + 1; j < tracks.size(); ++j) {
      const Candidate &a = all[tracks[i]], &b = all[tracks[j]];
      if (b.direction.z - a.direction.z > reach_rad) break;
      if (found[tracks[i]] || found[tracks[j]] || angle_rad(a.direction, b.direction) > reach_rad)
        continue;
      const auto row = only_source(frame, unit(a.direction + b.direction), reach_rad);
      if (!row || blended[*row]) continue;
      const auto blend = blend_of(a, b, frame, frame.sources[*row].observation);
      if (!blend) continue;
      found[tracks[i]] = a.track->take_part(blend->parts[0]);
      found[tracks[j]] = b.track->take_part(blend->parts[1]);
      blended[*row] = found[tracks[i]] || found[tracks[j]];
    }
}

void Fusion::associate(Scene& scene, const SensorFrame& frame,
                       std::span<const std::uint64_t> inside) {
  std::vector<Candidate> all = candidates(scene, frame, inside);
  SkyCells cells(frame.axis, std::min(pi, frame.half_angle_rad + largest_radius_rad));
  for (std::size_t k = 0; k < all.size(); ++k)
    cells.add(std::uint32_t(k), all[k].direction, all[k].radius_rad);
  cells.close();

  const double false_per_sr = settings_.false_alarms_per_frame / frame.solid_angle_sr();
  const double p = settings_.detection_probability;
  FramePairs pairs(p, false_per_sr);
  std::vector<std::pair<SimTime, PredictedDirection>> known(all.size());
  std::vector<signed char> lit(all.size(), -1);
  const auto is_lit = [&](std::size_t k) {
    if (lit[k] < 0) lit[k] = scene.sunlit(frame.sensor_m + all[k].direction * all[k].range_m) > 0;
    return lit[k] > 0;
  };
  std::vector<bool> found(all.size(), false), blended(frame.sources.size(), false);
  take_blends(frame, all, found, blended);
  for (std::size_t row = 0; row < frame.sources.size(); ++row) {
    if (blended[row]) continue;
    const AngleObservation& seen = frame.sources[row].observation;
    for (const std::uint32_t k : cells.near(seen.direction)) {
      if (found[k] || angle_rad(seen.direction, all[k].direction) > all[k].radius_rad ||
          (frame.needs_sunlight && !is_lit(k)))
        continue;
      auto& [time, direction] = known[k];
      if (direction.range_m == 0 || time != seen.time) {
        direction = predicted(all[k], frame, seen);
        time = seen.time;
      }
      if (direction.range_m == 0) continue;
      // The line of sight begins beside the sensor.
      PredictedDirection from_line = direction;
      from_line.direction =
          unit(direction.direction * direction.range_m - (seen.sensor_m - frame.sensor_m));
      const Innovation off = innovation_of(from_line, seen);
      if (!(off.d2 < settings_.gate_d2)) continue;
      const double spread = std::log((2 * pi) * (2 * pi) * off.covariance_rad2.determinant());
      if (all[k].burnt)
        pairs.add(row, k, off.d2 + burn_price, spread, 1.0);
      else
        pairs.add(row, k, off.d2, spread, all[k].track ? all[k].track->existence() : 1.0);
    }
  }
  const std::vector<std::size_t> columns = pairs.assigned(frame.sources.size(), all.size());
  const std::vector<double> others = pairs.others(columns);

  for (std::size_t row = 0; row < columns.size(); ++row) {
    if (blended[row]) continue;
    const SeenSource& source = frame.sources[row];
    LiveTrack* track = nullptr;
    if (columns[row] != unassigned) {
      Candidate& candidate = all[columns[row]];
      const bool fresh = !candidate.track;
      if (!fresh)
        track = candidate.track;
      else if (!track_of_[candidate.object])  // else it was seen without its manoeuvre, or with it
        track = begin_catalogued(candidate.object, source.observation.time, candidate.burnt);
      if (track && track->take(source.observation, source.magnitude, p, others[row])) {
        found[columns[row]] = true;
        if (track->place_roughly(forces_, scene.time) && fresh) scene.placed.push_back(track);
      } else {
        if (track && fresh) {  // the filter does not take what it began with
          track_of_[candidate.object] = nullptr;
          tracks_.pop_back();
          --next_id_;
        }
        track = nullptr;
      }
    }
    if (!track) scene.loose.push_back({source, false_per_sr, frame.frame});
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Candidate& c = all[k];
    if (found[k] || !c.track || c.sigma_rad > certain_sigma_rad || !is_lit(k)) continue;
    if (!c.track->brightness.is_known()) continue;
    if (!frame.shows(c.direction, edge_px)) continue;
    const double looked = frame.detection_probability(c.track->magnitude(c.range_m), p);
    if (looked > least_looked) c.track->miss(looked);
  }
}

}  // namespace dmise
