#include "bench/bench_catalogue.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "bench/figure.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/time/iso8601.h"
#include "core/tracking/maintenance/catalogue_object.h"
#include "tests/support/known_satellite.h"
#include "tests/support/watched_orbit.h"

namespace dmise {
namespace {

constexpr double day_s = 86400.0, grid_s = 30.0;
constexpr double albedo = 0.3;
constexpr double found_within_s = 12 * 3600.0;
constexpr double min_m_per_s = 0.02;         // smaller manoeuvres need not be found
constexpr double min_normal_m_per_s = 0.15;  // that element sets of three days show
constexpr double same_s = 3 * 3600.0;        // how far from its time a manoeuvre may be found

/// A satellite whose days from `start` have a precise orbit.
struct Days {
  const char* name;
  const char* logged;
  const char* start;
  int days;
};
constexpr Days satellites[] = {{"sentinel3a", "Sentinel-3A", "2018-12-24T22:00:00", 9},
                               {"jason1", "Jason-1", "2003-01-07T05:00:00", 9}};

/// Its days, with the places where watchers look.
struct Subject {
  Days of;
  KnownSatellite satellite;
  MaintenanceForces forces;
  std::vector<MotionState<Gcrs>> places;  // every grid_s

  Subject(const std::string& data, const Days& days)
      : of(days),
        satellite(data, days.name, days.start),
        forces(satellite.clock(), SimTime{}, sim_seconds(days.days * day_s)) {
    for (double t = 0; t <= days.days * day_s; t += grid_s)
      places.push_back(satellite.truth(sim_seconds(t)));
  }
  SimTime at_day(double day) const { return sim_seconds(day * day_s); }
  const MotionState<Gcrs>& place(SimTime t) const {
    return places[std::size_t(std::llround(t.seconds() / grid_s))];
  }
  OrbitState truth(SimTime t) const {
    const auto s = satellite.truth(t);
    return {t, s.position_m, s.velocity_m_per_s};
  }
  DiffuseSphere sphere() const { return {.radius_m = satellite.radius_m(), .albedo = albedo}; }
  OrbitEstimate believed_at(SimTime t, double age_days) const {
    return believed(satellite.elements(t, age_days), satellite.clock(), t);
  }
};

/// An object that is kept by passes, and what that tells.
struct Kept {
  CatalogueObject object;
  std::vector<FoundManoeuvre> found = {};
  std::size_t detections = 0, passes = 0, refused = 0;
  double seconds = 0.0;

  void feed(const std::vector<std::vector<AngleObservation>>& all, SimTime from, SimTime to) {
    const double begin = thread_seconds();
    for (const auto& pass : all) {
      if (pass.front().time < from || to < pass.back().time) continue;
      const auto news = object.take(pass);
      ++passes;
      detections += pass.size();
      refused += !news;
      if (news && news->manoeuvre) found.push_back(*news->manoeuvre);
    }
    seconds += thread_seconds() - begin;
  }
};

/// Errors of estimates beside the truth.
struct Errors {
  double squares_m2 = 0, nees = 0, worst_m = 0;
  int count = 0;

  void add(const Outcome<OrbitEstimate>& estimate, const OrbitState& truth) {
    if (!estimate) throw Error("an orbit ended: " + std::string(estimate.reason));
    const double off_m = norm(estimate->state.position_m - truth.position_m);
    squares_m2 += off_m * off_m;
    worst_m = std::max(worst_m, off_m);
    nees += dmise::nees(*estimate, truth) / 6;
    ++count;
  }
  double rms_m() const { return std::sqrt(squares_m2 / count); }
  double mean_nees() const { return nees / count; }
};

class Printer {
 public:
  Printer(std::string name, bool json) : name_(std::move(name)), json_(json) {}
  void operator()(const std::string& what, double value, const char* unit, double target = 0,
                  bool less_is_better = true) const {
    print_figure({.name = name_ + what,
                  .value = value,
                  .unit = unit,
                  .anchor = "precise orbits (SP3)",
                  .target = target,
                  .less_is_better = less_is_better},
                 json_);
  }

 private:
  std::string name_;
  bool json_;
};

/// Days, each from element sets of an age, by detections of 24 hours.
void bench_days(const Subject& s, const std::vector<OrbitWatcher>& network, double age_days,
                int seeds, const Printer& print) {
  const WatchedOrbit watched(
      s.satellite.clock(), [&](SimTime t) { return s.place(t); }, SimTime{}, s.at_day(s.of.days),
      s.sphere());
  Errors end, ahead, elements;
  double passes = 0, detections = 0, seconds = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto seen = watched.passes(network, {.seed = std::uint64_t(seed)});
    for (int day = 0; day + 2 <= s.of.days; ++day) {
      const SimTime from = s.at_day(day), to = s.at_day(day + 1), next = s.at_day(day + 2);
      Kept kept{CatalogueObject(s.forces, s.believed_at(from, age_days))};
      elements.add(s.believed_at(to, age_days), s.truth(to));
      kept.feed(seen, from, to);
      end.add(kept.object.estimate_at(to), s.truth(to));
      ahead.add(kept.object.estimate_at(next), s.truth(next));
      passes += double(kept.passes);
      detections += double(kept.detections);
      seconds += kept.seconds;
    }
  }
  print("_rms_m", end.rms_m(), "m", 50);
  print("_worst_m", end.worst_m, "m");
  print("_nees", end.mean_nees(), "1", 1.2);
  print("_next_day_rms_m", ahead.rms_m(), "m");
  print("_next_day_nees", ahead.mean_nees(), "1");
  print("_elements_rms_m", elements.rms_m(), "m");
  print("_passes", passes / end.count, "1");
  print("_detections", detections / end.count, "1");
  print("_trials", end.count, "1");
  print("_object_day_s", seconds / end.count, "s", 7.2);  // a thousand in an hour on two cores
}

/// Manoeuvres that are found where there is none.
void bench_quiet(const Subject& s, int seeds, const Printer& print) {
  const WatchedOrbit watched(
      s.satellite.clock(), [&](SimTime t) { return s.place(t); }, SimTime{}, s.at_day(s.of.days),
      s.sphere());
  std::size_t found = 0;
  Errors errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    Kept kept{CatalogueObject(s.forces, s.believed_at({}, 0.5))};
    const auto seen = watched.passes(wide_network(), {.seed = std::uint64_t(100 + seed)});
    for (int day = 1; day <= s.of.days; ++day) {
      kept.feed(seen, s.at_day(day - 1), s.at_day(day));
      errors.add(kept.object.estimate_at(s.at_day(day)), s.truth(s.at_day(day)));
    }
    found += kept.found.size();
  }
  const double weeks = seeds * s.of.days / 7.0;
  print("_false_a_week", double(found) / weeks, "1", 1);
  print("_kept_weeks", weeks, "1");
  print("_kept_rms_m", errors.rms_m(), "m");
  print("_kept_nees", errors.mean_nees(), "1");
}

struct FoundFigures {
  int logged = 0, found = 0, other = 0;
  double delay_s = 0, off_s = 0, size_d2 = 0, off_m_per_s = 0;
};

/// Flies a logged manoeuvre at its time of day on the precise orbit: what it changes comes from two
/// flights, all else is as it was.
void fly_manoeuvre(const Subject& s, const LoggedManoeuvre& logged, int number, FoundFigures& out) {
  const double of_day =
      std::fmod((s.satellite.clock().sim_time(parse_utc(logged.utc)).seconds()), day_s);
  const int day = number % (s.of.days - 3);
  const SimTime from = s.at_day(day),
                at = s.at_day(day + 1) + sim_seconds(of_day < 0 ? of_day + day_s : of_day);
  const SimTime to = at + sim_seconds(found_within_s);
  const Vec<Rtn> change{0, logged.transverse_m_per_s, logged.normal_m_per_s};
  OrbitState before = s.truth(at - sim_seconds(60));
  before.srp_m2_per_kg = 0.01;
  const auto quiet = ArcPath::fly(s.forces, before, {}, to + sim_seconds(grid_s));
  const VelocityChange burn{at, change};
  const auto burnt = ArcPath::fly(s.forces, before, std::span(&burn, 1), to + sim_seconds(grid_s));
  if (!quiet || !burnt) throw Error("a manoeuvre has no path");
  const auto truth = [&](SimTime t) {
    MotionState<Gcrs> state = s.place(t);
    if (t < at) return state;
    const OrbitState a = quiet->at(t), b = burnt->at(t);
    state.position_m += b.position_m - a.position_m;
    state.velocity_m_per_s += b.velocity_m_per_s - a.velocity_m_per_s;
    return state;
  };
  const WatchedOrbit watched(s.satellite.clock(), truth, from, to, s.sphere());
  Kept kept{CatalogueObject(s.forces, s.believed_at(from, 0.5))};
  kept.feed(watched.passes(wide_network(), {.seed = std::uint64_t(1000 + number)}), from, to);
  ++out.logged;
  bool found = false;
  for (const FoundManoeuvre& m : kept.found) {
    const double off_s = (m.change.time - at).seconds();
    if (m.found < at || std::fabs(off_s) > std::max(same_s, 3 * m.time_sigma_s) || found) {
      ++out.other;
      continue;
    }
    found = true;
    ++out.found;
    const FoundManoeuvre& last = kept.object.manoeuvres().back();  // as all passes have it
    const Vec<Rtn>& v = last.change.delta_v_m_per_s;
    const Eigen::Vector3d off(v.x - change.x, v.y - change.y, v.z - change.z);
    out.delay_s += (m.found - at).seconds();
    out.off_s += std::fabs((last.change.time - at).seconds());
    out.off_m_per_s += off.norm();
    out.size_d2 += off.dot(last.covariance.ldlt().solve(off)) / 3;
  }
}

void bench_manoeuvres(const Subject& s, const std::string& data, const Printer& print) {
  FoundFigures f;
  int number = 0;
  for (LoggedManoeuvre m : logged_manoeuvres(data, s.of.logged)) {
    if (std::fabs(m.normal_m_per_s) < min_normal_m_per_s) m.normal_m_per_s = 0;
    if (std::hypot(m.transverse_m_per_s, m.normal_m_per_s) < min_m_per_s) continue;
    fly_manoeuvre(s, m, number++, f);
  }
  print("_manoeuvres", f.logged, "1");
  print("_manoeuvres_found", double(f.found) / f.logged, "1", 0.9, false);
  print("_manoeuvres_others", f.other, "1");
  print("_found_after_h", f.delay_s / std::max(1, f.found) / 3600, "h", 12);
  print("_time_off_s", f.off_s / std::max(1, f.found), "s");
  print("_size_off_m_per_s", f.off_m_per_s / std::max(1, f.found), "m/s");
  print("_size_nees", f.size_d2 / std::max(1, f.found), "1");
}

}  // namespace

int bench_catalogue(bool json) {
  const char* root = std::getenv("DMISE_DATA");
  if (!root) {
    std::fputs("dmise bench catalogue: orbits are compared with data in $DMISE_DATA\n", stderr);
    return 0;
  }
  constexpr int seeds = 4;
  for (const Days& of : satellites) {
    const Subject s(root, of);
    const std::string name = std::string("kept_") + of.name;
    bench_days(s, wide_network(), 0.5, seeds, Printer(name + "_day", json));
    bench_days(s, wide_network(), 14, 1, Printer(name + "_day_old", json));
    bench_days(s, survey_network(), 0.5, 1, Printer(name + "_day_survey", json));
    bench_quiet(s, seeds, Printer(name, json));
    bench_manoeuvres(s, root, Printer(name, json));
  }
  return 0;
}

}  // namespace dmise
