#include "bench/keeping/kept_satellite.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double place_step_s = 30.0;
constexpr double albedo = 0.3;

bool is_own(const SeenMotion& source) { return source.observation.detection_id.ends_with("/0"); }

}  // namespace

WatchedSatellite::WatchedSatellite(const std::string& data, const SatelliteDays& days,
                                   const MaintenanceSettings& settings)
    : of(days),
      satellite(data, days.name, days.start),
      forces(satellite.clock(), SimTime{}, sim_seconds(days.days * day_s), settings) {
  for (double t = 0; t <= days.days * day_s; t += place_step_s)
    places.push_back(satellite.truth(sim_seconds(t)));
}

SimTime WatchedSatellite::at_day(double day) const { return sim_seconds(day * day_s); }

const MotionState<Gcrs>& WatchedSatellite::place(SimTime t) const {
  return places[std::size_t(std::llround(t.seconds() / place_step_s))];
}

OrbitState WatchedSatellite::truth(SimTime t) const {
  const auto s = satellite.truth(t);
  return {t, s.position_m, s.velocity_m_per_s};
}

DiffuseSphere WatchedSatellite::sphere() const {
  return {.radius_m = satellite.radius_m(), .albedo = albedo};
}

OrbitEstimate WatchedSatellite::believed_at(SimTime t, double age_days) const {
  return believed(satellite.elements(t, age_days), satellite.clock(), t);
}

WatchedOrbit WatchedSatellite::watched() const {
  return {satellite.clock(), [this](SimTime t) { return place(t); }, SimTime{}, at_day(of.days),
          sphere()};
}

WatchedCrowd WatchedSatellite::crowd(std::vector<MeanElements> elements) const {
  const std::uint32_t own = satellite.elements(at_day(of.days), 0).catalogue_number;
  std::erase_if(elements, [&](const MeanElements& e) { return e.catalogue_number == own; });
  return {std::move(elements), satellite.clock(), sphere()};
}

void OrbitErrors::add(const Outcome<OrbitEstimate>& estimate, const OrbitState& truth) {
  if (!estimate) throw Error("an orbit ended: " + std::string(estimate.reason));
  const double off_m = norm(estimate->state.position_m - truth.position_m);
  squares_m2 += off_m * off_m;
  worst_m = std::max(worst_m, off_m);
  nees += dmise::nees(*estimate, truth) / 6;
  ++count;
}

void OrbitErrors::add(const OrbitErrors& other) {
  squares_m2 += other.squares_m2;
  nees += other.nees;
  worst_m = std::max(worst_m, other.worst_m);
  count += other.count;
}

double OrbitErrors::rms_m() const { return std::sqrt(squares_m2 / count); }

void AssociationTally::add(const AssociationTally& other) {
  own += other.own;
  others += other.others;
  exposures += other.exposures;
  right += other.right;
  wrong += other.wrong;
  ambiguous += other.ambiguous;
}

void KeptSatellite::take(const std::vector<AngleObservation>& pass) {
  const auto news = object.take(pass);
  ++passes;
  detections += pass.size();
  if (news && news->manoeuvre) found.push_back(*news->manoeuvre);
}

void KeptSatellite::feed(const std::vector<std::vector<AngleObservation>>& all, SimTime from,
                         SimTime to) {
  for (const auto& pass : all)
    if (from <= pass.front().time && pass.back().time <= to) take(pass);
}

void KeptSatellite::feed(const MaintenanceForces& forces,
                         const std::vector<std::vector<PassExposure>>& all, SimTime from,
                         SimTime to, const PassAssociationSettings& settings) {
  for (const auto& pass : all) {
    if (pass.front().time < from || to < pass.back().time) continue;
    std::set<std::string> own;
    for (const PassExposure& e : pass) {
      ++tally.exposures;
      for (const SeenMotion& s : e.sources)
        if (is_own(s)) own.insert(s.observation.detection_id);
      tally.others += e.sources.size();
    }
    tally.own += own.size();
    tally.others -= own.size();
    const auto arc = associate_pass(forces, object, pass, settings);
    if (!arc) throw Error("a pass isn't associated: " + std::string(arc.reason));
    tally.ambiguous += arc->ambiguous;
    for (const AngleObservation& o : arc->observations)
      ++(own.contains(o.detection_id) ? tally.right : tally.wrong);
    if (!arc->observations.empty()) take(arc->observations);
  }
}

}  // namespace dmise
