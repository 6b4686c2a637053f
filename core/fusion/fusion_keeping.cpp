#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/fusion/fusion.h"

// Orbits that are kept from one arc of detections to the next.
namespace dmise {
namespace {

constexpr double arc_gap_s = 300.0;       // without a detection, after which an arc is whole
constexpr double max_arc_s = 1800.0;      // longest arc: objects that stay in view have many
constexpr double before_arc_s = 60.0;     // from the prior of an object in no catalogue to its arc
constexpr double prior_inflation = 10.0;  // factor of its errors, which are of the same detections
// Between a breakup's place and that of its parent, 3 degrees of freedom; 16.3: 1e-3.
constexpr double parent_gate_d2 = 16.3;

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

void Fusion::keep_arcs(SimTime time, FusionTick& out) {
  for (const auto& track : tracks_) {
    if (!is_closed(*track, time)) continue;
    if (auto orbit = keep(*track)) {
      orbit->kept = time;
      out.orbits.push_back(std::move(*orbit));
      if (auto breakup = breakup_of(*track->object)) {
        breakup->announced = time;
        out.breakups.push_back(std::move(*breakup));
      }
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

std::optional<FoundBreakup> Fusion::breakup_of(std::size_t object) {
  if (object < catalogue_.size()) return std::nullopt;
  const auto first_seen = kept_->at_begin(object);
  if (!first_seen) return std::nullopt;
  pinches_->put(object, *first_seen);
  const auto point = pinches_->of(object);
  if (!point) return std::nullopt;
  const auto is_known = [&](const std::vector<std::size_t>& members) {
    return std::ranges::count_if(members, [&](std::size_t m) {
             return std::ranges::binary_search(point->members, m);
           }) >= 2;
  };
  auto known = std::ranges::find_if(breakups_, is_known);
  if (known == breakups_.end()) known = breakups_.emplace(known);
  if (point->members.size() <= known->size()) return std::nullopt;
  *known = point->members;
  FoundBreakup out{.breakup = std::uint32_t(known - breakups_.begin() + 1),
                   .announced = {},
                   .time = point->time,
                   .time_sigma_s = point->time_sigma_s,
                   .position_m = point->position_m,
                   .covariance = lower_triangle<3>(point->covariance),
                   .parent = {},
                   .parent_name = {},
                   .members = {},
                   .chi_square = point->chi_square,
                   .degrees = std::uint32_t(point->degrees),
                   .confidence = point->confidence};
  for (const std::size_t member : point->members) {
    std::uint32_t number = 0;
    name_object(member, number, out.members.emplace_back());
  }
  name_parent(*point, out);
  return out;
}

void Fusion::name_parent(const PinchPoint& point, FoundBreakup& breakup) {
  catalogue_.move(point.time);  // the next scene moves it to its own
  const double sigma_m = std::sqrt(point.covariance.trace());
  double nearest = parent_gate_d2;
  for (std::size_t i = 0; i < catalogue_.size(); ++i) {
    if (!catalogue_.known(i)) continue;
    const double reach_m = std::sqrt(parent_gate_d2) * (catalogue_.sigma_m(i) + sigma_m);
    const Vec<Gcrs> apart = catalogue_.position_m(i) - point.position_m;
    if (norm(apart) > reach_m || norm(catalogue_.velocity_m_per_s(i) - point.velocity_m_per_s) >
                                     PinchSettings{}.max_apart_m_per_s)
      continue;
    const Eigen::Matrix3d both =
        catalogue_.estimate(i).covariance.topLeftCorner<3, 3>() + point.covariance;
    const double d2 = eigen_of(apart).dot(both.ldlt().solve(eigen_of(apart)));
    if (d2 >= nearest) continue;
    nearest = d2;
    breakup.parent = std::to_string(catalogue_.elements(i).catalogue_number);
    breakup.parent_name = catalogue_.elements(i).name;
  }
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
