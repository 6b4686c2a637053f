#include <algorithm>

#include "core/fusion/fusion.h"

// Orbits that are kept from one arc of detections to the next.
namespace dmise {
namespace {

constexpr double arc_gap_s = 300.0;       // without a detection, after which an arc is whole
constexpr double max_arc_s = 1800.0;      // longest arc: objects that stay in view have many
constexpr double before_arc_s = 60.0;     // from the prior of an object in no catalogue to its arc
constexpr double prior_inflation = 10.0;  // factor of its errors, which are of the same detections

}  // namespace

/// What is known of an object without a track at about a time: by its kept orbit, if it has one
/// that reaches there, else by its elements at the time of the scene.
Outcome<OrbitEstimate> Fusion::believed(std::size_t object, SimTime time) const {
  if (kept_ && kept_->has(object)) {
    auto kept = kept_->estimate(object, time);
    if (!kept && object < catalogue_.size()) return catalogue_.estimate(object);
    if (!kept) return kept;
    // A filter of minutes takes the scales as known.
    kept->covariance.bottomRows<2>().setZero();
    kept->covariance.rightCols<2>().setZero();
    return kept;
  }
  return catalogue_.estimate(object);
}

bool Fusion::is_closed(const LiveTrack& track, SimTime time) const {
  if (!track.arc || track.arc->empty() || track.status != TrackStatus::confirmed) return false;
  const double unseen_s = (time - track.last_seen).seconds();
  if (unseen_s > std::min(arc_gap_s, settings_.lost_after_s)) return true;
  const auto [first, last] = std::ranges::minmax(*track.arc, {}, &AngleObservation::time);
  return (last.time - first.time).seconds() > max_arc_s;
}

void Fusion::keep_arcs(SimTime time, std::vector<KeptOrbit>& orbits) {
  for (const auto& track : tracks_) {
    if (!is_closed(*track, time)) continue;
    if (auto orbit = keep(*track)) {
      orbit->kept = time;
      orbits.push_back(std::move(*orbit));
    }
    track->arc->clear();
  }
}

std::optional<KeptOrbit> Fusion::keep(LiveTrack& track) {
  const SimTime first = std::ranges::min(*track.arc, {}, &AngleObservation::time).time;
  OrbitEstimate prior;
  if (track.began_with) {
    prior = *track.began_with;
  } else if (!track.object) {
    auto seen = propagate(forces_, track.filter.estimate(), first - sim_seconds(before_arc_s),
                          {.position_tolerance_m = 1e-2});
    if (!seen) return std::nullopt;
    prior = *seen;
    prior.covariance *= prior_inflation * prior_inflation;
    if (const auto object = owner_of(track, prior.state)) {
      track.object = object;
      track_of_[*object] = &track;
    }
  }
  const bool is_new = !track.object;
  const std::size_t object = is_new ? catalogue_.size() + new_objects_.size() : *track.object;
  auto orbit = kept_->take(object, prior, *track.arc);
  if (!orbit) return std::nullopt;
  if (is_new) {
    new_objects_.push_back(track.id);
    track_of_.push_back(&track);
    track.object = object;
  }
  orbit->track = track.id;
  name_object(object, orbit->catalogue_number, orbit->name);
  orbit->object = orbit->catalogue_number ? std::to_string(orbit->catalogue_number) : orbit->name;
  return *orbit;
}

std::optional<std::size_t> Fusion::owner_of(const LiveTrack& track, const OrbitState& seen) {
  return kept_->owner_of(seen, *track.arc,
                         [&](std::size_t object) { return track_of_[object] == nullptr; });
}

void Fusion::name_object(std::size_t object, std::uint32_t& catalogue_number,
                         std::string& name) const {
  if (object >= catalogue_.size()) {
    name = "new-" + std::to_string(new_objects_[object - catalogue_.size()]);
    return;
  }
  catalogue_number = catalogue_.elements(object).catalogue_number;
  name = catalogue_.elements(object).name;
}

}  // namespace dmise
