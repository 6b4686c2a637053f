#include "core/fusion/fusion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <tuple>

#include "core/fusion/fusion_scene.h"

namespace dmise {
namespace {

constexpr double together_s = 2.0;       // exposures that share a prediction of the catalogue
constexpr double prior_before_s = 60.0;  // that late detections may precede the first
constexpr double same_gate_d2 = 30.0;    // between two states of one object, 3 degrees of freedom
// Share of an orbit's exposures in which a track took another source, that makes it another object.
constexpr double seen_beside_share = 0.7;
constexpr double gone = 0.02;             // probability of existence at which a track ends
constexpr double certain = 0.99;          // and with which it may be confirmed
constexpr double around_run_s = 86400.0;  // that kept orbits reach beyond the run at either end

FilterSettings filter_settings(const FusionSettings& s) {
  FilterSettings out;
  out.acceleration_noise_m2_per_s3 = s.acceleration_noise_m2_per_s3;
  out.kept = 24;
  return out;
}

bool holds(const std::vector<std::string>& ids, const LooseSource& source) {
  return std::ranges::find(ids, seen(source).detection_id) != ids.end();
}

}  // namespace

Fusion::Fusion(std::vector<MeanElements> catalogue, const Clock& clock, SimTime reference,
               const FusionSettings& settings)
    : clock_(clock),
      settings_(settings),
      forces_(clock, reference),
      filter_(filter_settings(settings)),
      catalogue_(std::move(catalogue), clock, settings),
      start_(forces_, settings),
      arcs_(forces_, settings),
      track_of_(catalogue_.size(), nullptr) {
  if (!settings.keep_orbits) return;
  const SimTime end{2 * reference.ns};
  const SimTime first = SimTime{} - sim_seconds(around_run_s);
  kept_ = std::make_unique<KeptOrbits>(clock, first, end + sim_seconds(around_run_s));
  pinches_ = std::make_unique<PinchSearch>(kept_->forces(), first);
}

FusionTick Fusion::step(SimTime time, std::vector<SensorFrame> frames) {
  std::ranges::sort(frames, [](const SensorFrame& a, const SensorFrame& b) {
    return std::tie(a.time, a.sensor, a.frame) < std::tie(b.time, b.sensor, b.frame);
  });
  std::vector<LooseSource> loose;
  for (std::size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
    while (end < frames.size() && (frames[end].time - frames[begin].time).seconds() <= together_s)
      ++end;
    const std::span<const SensorFrame> group{frames.data() + begin, end - begin};
    catalogue_.move(group[group.size() / 2].time);
    Scene scene(clock_, catalogue_, settings_.ellipsoid);
    for (const auto& track : tracks_)
      if (track->place_roughly(forces_, scene.time)) scene.placed.push_back(track.get());
    if (kept_) scene.kept = kept_->places(scene.time);
    const std::size_t words = cone_words(catalogue_.size());
    const auto inside = scene.objects_in(group, catalogue_);
    for (std::size_t k = 0; k < group.size(); ++k)
      associate(scene, group[k], {inside.data() + k * words, words});
    loose.insert(loose.end(), scene.loose.begin(), scene.loose.end());
  }
  begin_unknown(loose);
  if (settings_.arc_exposures > 0) begin_from_arcs(loose);
  FusionTick out;
  if (kept_) keep_arcs(time, out);
  age(time);

  for (const auto& track : tracks_) {
    if (track->status != TrackStatus::lost) ++out.live;
    if (!track->changed) continue;
    Track& told = out.tracks.emplace_back(published(*track, time));
    if (track->object) name_object(*track->object, told.catalogue_number, told.name);
    track->associated.clear();
    track->changed = false;
  }
  out.unassociated = std::uint32_t(std::ranges::count_if(loose, [&](const LooseSource& s) {
    return std::ranges::none_of(out.tracks, [&](const Track& t) { return holds(t.associated, s); });
  }));
  std::erase_if(tracks_, [](const auto& t) { return t->status == TrackStatus::lost; });
  return out;
}

LiveTrack* Fusion::begin_catalogued(std::size_t object, SimTime seen, bool burnt) {
  const auto now = burnt ? kept_->burnt(object, seen) : believed(object, seen);
  if (!now) return nullptr;
  auto prior =
      propagate(forces_, *now, seen - sim_seconds(prior_before_s), {.position_tolerance_m = 1e-2});
  if (!prior || !OrbitFilter::can_start(*prior)) return nullptr;
  tracks_.push_back(
      std::make_unique<LiveTrack>(next_id_++, OrbitFilter(forces_, *prior, filter_), object));
  if (kept_) {
    tracks_.back()->began_with = *prior;
    tracks_.back()->arc.emplace();
  }
  track_of_[object] = tracks_.back().get();
  return tracks_.back().get();
}

bool Fusion::is_known(const StartedOrbit& orbit) const {
  const OrbitEstimate& estimate = orbit.fit.estimate;
  for (const auto& track : tracks_) {
    // An object that was seen beside the orbit's points is another, however near.
    const auto beside = std::ranges::count_if(orbit.sources, [&](const LooseSource& s) {
      return s.source.is_point && track->is_seen_beside(seen(s).detection_id);
    });
    if (double(beside) > seen_beside_share * double(orbit.sources.size())) continue;
    const auto other =
        track->filter.estimate_at(std::max(estimate.state.time, track->filter.time()));
    if (!other) continue;
    const auto here =
        propagate(forces_, estimate, other->state.time, {.position_tolerance_m = 1e-2});
    if (!here) continue;
    const Eigen::Vector3d apart = eigen_of(here->state.position_m - other->state.position_m);
    const Eigen::Matrix3d both =
        here->covariance.topLeftCorner<3, 3>() + other->covariance.topLeftCorner<3, 3>();
    if (apart.dot(both.ldlt().solve(apart)) < same_gate_d2) return true;
  }
  return false;
}

void Fusion::take_rest(LiveTrack& track, const std::vector<LooseSource>& loose,
                       std::vector<std::string>& taken) {
  for (const LooseSource& s : loose) {
    if (seen(s).time < track.filter.time() - sim_seconds(settings_.start_window_s) ||
        holds(taken, s))
      continue;
    const auto found = track.filter.innovation(seen(s));
    if (!found || found->d2 > settings_.gate_d2) continue;
    if (track.take(seen(s), s.source.magnitude, settings_.detection_probability, s.false_per_sr))
      taken.push_back(seen(s).detection_id);
  }
}

void Fusion::begin_unknown(const std::vector<LooseSource>& loose) {
  for (const StartedOrbit& orbit : start_.add(loose)) {
    const auto is_loose = [&](const LooseSource& s) {
      return std::ranges::any_of(start_.loose(), [&](const LooseSource& other) {
        return seen(other).detection_id == seen(s).detection_id;
      });
    };
    if (!std::ranges::all_of(orbit.sources, is_loose)) continue;  // another took it
    if (!is_known(orbit)) begin(orbit, settings_.confirm_unknown);
  }
}

void Fusion::begin_from_arcs(const std::vector<LooseSource>& loose) {
  std::vector<LooseSource> left;
  for (const LooseSource& s : loose)
    if (std::ranges::none_of(tracks_, [&](const auto& t) { return holds(t->associated, s); }))
      left.push_back(s);
  for (const StartedOrbit& orbit : arcs_.add(left))
    if (!is_known(orbit)) begin(orbit, int(orbit.sources.size()) + settings_.confirm_arc);
}

void Fusion::begin(const StartedOrbit& orbit, int min_detections) {
  if (!OrbitFilter::can_start(orbit.fit.estimate)) return;
  auto track = std::make_unique<LiveTrack>(
      next_id_, OrbitFilter(forces_, orbit.fit.estimate, filter_), std::nullopt);
  track->min_detections = min_detections;
  if (kept_) track->arc.emplace();
  std::vector<std::string> taken;
  for (const LooseSource& s : orbit.sources) {
    taken.push_back(seen(s).detection_id);
    track->count(seen(s), s.source.magnitude, orbit.fit.estimate.state.position_m);
  }
  take_rest(*track, start_.loose(), taken);
  start_.forget(taken);
  arcs_.forget(taken);
  tracks_.push_back(std::move(track));
  ++next_id_;
}

void Fusion::age(SimTime time) {
  for (const auto& track : tracks_) {
    const double unseen_s = (time - track->last_seen).seconds();
    const bool tentative = track->status == TrackStatus::tentative;
    const int wanted = track->object ? settings_.confirm_catalogued : track->min_detections;
    if (track->existence() < gone ||
        unseen_s > (tentative ? settings_.tentative_s : settings_.lost_after_s)) {
      track->status = TrackStatus::lost;
      track->changed = true;
      if (track->object) track_of_[*track->object] = nullptr;
    } else if (tentative && track->detections >= wanted && track->existence() > certain) {
      track->status = TrackStatus::confirmed;
      track->changed = true;
    }
  }
}

std::vector<CueTarget> Fusion::targets(SimTime time) const {
  std::vector<CueTarget> out;
  for (const auto& track : tracks_) {
    auto estimate = track->filter.estimate_at(time);
    if (!estimate || track->detections == 0) continue;
    CueTarget target{.track = track->id,
                     .existence = track->existence(),
                     .magnitude = track->magnitude(1e6),
                     .estimate = std::move(*estimate)};
    if (track->object) name_object(*track->object, target.catalogue_number, target.name);
    out.push_back(std::move(target));
  }
  return out;
}

}  // namespace dmise
