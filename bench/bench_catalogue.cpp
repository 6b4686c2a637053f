#include "bench/bench_catalogue.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/catalogue_file.h"
#include "bench/figure.h"
#include "bench/keeping/kept_satellite.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/units.h"
#include "core/orbit/elements/catalogue.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double grid_s = 30.0;
constexpr double found_within_s = 12 * 3600.0;
constexpr double min_m_per_s = 0.02;         // smaller manoeuvres need not be found
constexpr double min_normal_m_per_s = 0.15;  // that element sets of three days show
constexpr double same_s = 3 * 3600.0;        // how far from its time a manoeuvre may be found
constexpr double yesterday_days = 0.5, old_days = 14;
constexpr int threads = 2;

constexpr SatelliteDays satellites[] = {{"sentinel3a", "Sentinel-3A", "2018-12-24T22:00:00", 9},
                                        {"jason1", "Jason-1", "2003-01-07T05:00:00", 9}};

/// Telescopes expose from a pass's begin to its end, since exposures a minute apart say little of
/// the range.
std::vector<OrbitWatcher> spread(std::vector<OrbitWatcher> network) {
  for (OrbitWatcher& watcher : network) watcher.spread = true;
  return network;
}

/// Results of `count` independent trials, by their order.
template <class Trial>
auto trials(std::size_t count, Trial&& trial) {
  std::vector<decltype(trial(std::size_t{}))> out(count);
  Threads(threads).for_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = trial(i);
  });
  return out;
}

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

/// Days that were kept from an element set each.
struct DayFigures {
  OrbitErrors end, ahead, elements;
  double passes = 0, detections = 0, seconds = 0;
  AssociationTally tally;

  void add(const WatchedSatellite& s, const KeptSatellite& kept, int day, double age_days) {
    const SimTime to = s.at_day(day + 1), next = s.at_day(day + 2);
    elements.add(s.believed_at(to, age_days), s.truth(to));
    end.add(kept.object.estimate_at(to), s.truth(to));
    ahead.add(kept.object.estimate_at(next), s.truth(next));
    passes += double(kept.passes);
    detections += double(kept.detections);
    tally.add(kept.tally);
  }
  void add(const DayFigures& other) {
    end.add(other.end);
    ahead.add(other.ahead);
    elements.add(other.elements);
    passes += other.passes;
    detections += other.detections;
    seconds += other.seconds;
    tally.add(other.tally);
  }
  void print_errors(const Printer& print) const {
    print("_rms_m", end.rms_m(), "m", 50);
    print("_worst_m", end.worst_m, "m");
    print("_nees", end.mean_nees(), "1", 1.2);
  }
};

DayFigures sum_of(const std::vector<DayFigures>& all) {
  DayFigures out;
  for (const DayFigures& f : all) out.add(f);
  return out;
}

/// Days, each from element sets of an age, by detections of 24 hours.
void bench_days(const WatchedSatellite& s, const std::vector<OrbitWatcher>& network,
                double age_days, int seeds, const Printer& print) {
  const WatchedOrbit watched = s.watched();
  const int days = s.of.days - 1;
  const DayFigures sum = sum_of(trials(std::size_t(seeds * days), [&](std::size_t i) {
    const int seed = int(i) / days + 1, day = int(i) % days;
    const auto seen = watched.passes(network, {.seed = std::uint64_t(seed)});
    KeptSatellite kept{CatalogueObject(s.forces, s.believed_at(s.at_day(day), age_days))};
    DayFigures out;
    const double begin = thread_seconds();
    kept.feed(seen, s.at_day(day), s.at_day(day + 1));
    out.seconds = thread_seconds() - begin;
    out.add(s, kept, day, age_days);
    return out;
  }));
  sum.print_errors(print);
  print("_next_day_rms_m", sum.ahead.rms_m(), "m");
  print("_next_day_nees", sum.ahead.mean_nees(), "1");
  print("_elements_rms_m", sum.elements.rms_m(), "m");
  print("_passes", sum.passes / sum.end.count, "1");
  print("_detections", sum.detections / sum.end.count, "1");
  print("_trials", sum.end.count, "1");
  print("_object_day_s", sum.seconds / sum.end.count, "s", 7.2);  // a thousand an hour on two cores
}

/// Days as above, with the detections to be told from those of all other objects of a catalogue.
void bench_crowd(const WatchedSatellite& s, const std::vector<MeanElements>& others,
                 double age_days, int seeds, const PassAssociationSettings& settings,
                 const Printer& print) {
  const WatchedOrbit watched = s.watched();
  const auto network = spread(wide_network());
  const DayFigures sum = sum_of(trials(std::size_t(seeds), [&](std::size_t i) {
    const WatchedOrbit::Draw draw{.seed = i + 1};
    const auto seen = s.crowd(others).passes(watched.exposures(network, draw), draw);
    DayFigures out;
    for (int day = 0; day + 2 <= s.of.days; ++day) {
      KeptSatellite kept{CatalogueObject(s.forces, s.believed_at(s.at_day(day), age_days))};
      kept.feed(s.forces, seen, s.at_day(day), s.at_day(day + 1), settings);
      out.add(s, kept, day, age_days);
    }
    return out;
  }));
  const AssociationTally& t = sum.tally;
  sum.print_errors(print);
  print("_others", double(others.size()), "1");
  print("_others_near", double(t.others) / double(t.exposures), "1");  // detections of an exposure
  print("_wrong", double(t.wrong) / double(std::max<std::size_t>(1, t.right + t.wrong)), "1");
  print("_missed", 1 - double(t.right) / double(t.own), "1");
  print("_ambiguous", double(t.ambiguous) / double(t.own), "1");
  print("_trials", sum.end.count, "1");
}

/// Manoeuvres that are found where there is none.
void bench_quiet(const WatchedSatellite& s, int seeds, const Printer& print) {
  const WatchedOrbit watched = s.watched();
  struct Quiet {
    std::size_t found = 0;
    OrbitErrors errors;
  };
  Quiet sum;
  for (const Quiet& q : trials(std::size_t(seeds), [&](std::size_t i) {
         KeptSatellite kept{CatalogueObject(s.forces, s.believed_at({}, yesterday_days))};
         const auto seen = watched.passes(spread(wide_network()), {.seed = 101 + i});
         Quiet out;
         for (int day = 1; day <= s.of.days; ++day) {
           kept.feed(seen, s.at_day(day - 1), s.at_day(day));
           out.errors.add(kept.object.estimate_at(s.at_day(day)), s.truth(s.at_day(day)));
         }
         out.found = kept.found.size();
         return out;
       })) {
    sum.found += q.found;
    sum.errors.add(q.errors);
  }
  const double weeks = seeds * s.of.days / 7.0;
  print("_false_a_week", double(sum.found) / weeks, "1", 1);
  print("_kept_weeks", weeks, "1");
  print("_kept_rms_m", sum.errors.rms_m(), "m");
  print("_kept_nees", sum.errors.mean_nees(), "1");
}

struct FoundFigures {
  int logged = 0, found = 0, other = 0;
  double delay_s = 0, off_s = 0, time_d2 = 0, size_d2 = 0, off_m_per_s = 0;

  void add(const FoundFigures& f) {
    logged += f.logged, found += f.found, other += f.other;
    delay_s += f.delay_s, off_s += f.off_s, time_d2 += f.time_d2;
    size_d2 += f.size_d2, off_m_per_s += f.off_m_per_s;
  }
};

/// A logged manoeuvre at its time of day on the precise orbit: what it changes comes from two
/// flights, all else is as it was.
class FlownManoeuvre {
 public:
  FlownManoeuvre(const WatchedSatellite& s, const LoggedManoeuvre& logged, int number)
      : s_(s), change_{0, logged.transverse_m_per_s, logged.normal_m_per_s} {
    const double of_day =
        std::fmod((s.satellite.clock().sim_time(parse_utc(logged.utc)).seconds()), day_s);
    const int day = number % (s.of.days - 3);
    from_ = s.at_day(day);
    at_ = s.at_day(day + 1) + sim_seconds(of_day < 0 ? of_day + day_s : of_day);
    to_ = at_ + sim_seconds(found_within_s);
    OrbitState before = s.truth(at_ - sim_seconds(60));
    before.srp_m2_per_kg = 0.01;
    const SimTime end = to_ + sim_seconds(grid_s);
    const VelocityChange burn{at_, change_};
    quiet_ = ArcPath::fly(s.forces, before, {}, end).value;
    burnt_ = ArcPath::fly(s.forces, before, std::span(&burn, 1), end).value;
    if (!quiet_ || !burnt_) throw Error("a manoeuvre has no path");
  }

  SimTime from() const { return from_; }
  SimTime to() const { return to_; }
  WatchedOrbit watched() const {
    return {s_.satellite.clock(), [this](SimTime t) { return truth(t); }, from_, to_, s_.sphere()};
  }

  FoundFigures score(const KeptSatellite& kept) const {
    FoundFigures out{.logged = 1};
    for (const FoundManoeuvre& m : kept.found) {
      const double off_s = (m.change.time - at_).seconds();
      if (m.found < at_ || std::fabs(off_s) > std::max(same_s, 3 * m.time_sigma_s) || out.found) {
        ++out.other;
        continue;
      }
      out.found = 1;
      out.delay_s = (m.found - at_).seconds();
      const FoundManoeuvre& last = kept.object.manoeuvres().back();  // as all passes have it
      const Vec<Rtn>& v = last.change.delta_v_m_per_s;
      const Eigen::Vector3d off(v.x - change_.x, v.y - change_.y, v.z - change_.z);
      out.off_s = std::fabs((last.change.time - at_).seconds());
      out.time_d2 = out.off_s * out.off_s / (last.time_sigma_s * last.time_sigma_s);
      out.off_m_per_s = off.norm();
      out.size_d2 = off.dot(last.covariance.ldlt().solve(off)) / 3;
    }
    return out;
  }

 private:
  MotionState<Gcrs> truth(SimTime t) const {
    MotionState<Gcrs> state = s_.place(t);
    if (t < at_) return state;
    const OrbitState a = quiet_->at(t), b = burnt_->at(t);
    state.position_m += b.position_m - a.position_m;
    state.velocity_m_per_s += b.velocity_m_per_s - a.velocity_m_per_s;
    return state;
  }

  const WatchedSatellite& s_;
  Vec<Rtn> change_;
  SimTime from_, at_, to_;
  std::optional<ArcPath> quiet_, burnt_;
};

std::vector<LoggedManoeuvre> manoeuvres_to_find(const std::string& data, const SatelliteDays& of) {
  std::vector<LoggedManoeuvre> out;
  for (LoggedManoeuvre m : logged_manoeuvres(data, of.logged)) {
    if (std::fabs(m.normal_m_per_s) < min_normal_m_per_s) m.normal_m_per_s = 0;
    if (std::hypot(m.transverse_m_per_s, m.normal_m_per_s) >= min_m_per_s) out.push_back(m);
  }
  return out;
}

/// `others`: null if associations are given.
void bench_manoeuvres(const WatchedSatellite& s, const std::string& data,
                      const std::vector<MeanElements>* others, const Printer& print) {
  const auto logged = manoeuvres_to_find(data, s.of);
  const auto network = spread(wide_network());
  FoundFigures f;
  for (const FoundFigures& one : trials(logged.size(), [&](std::size_t i) {
         const FlownManoeuvre flown(s, logged[i], int(i));
         const WatchedOrbit::Draw draw{.seed = 1000 + i};
         KeptSatellite kept{CatalogueObject(s.forces, s.believed_at(flown.from(), yesterday_days))};
         if (others)
           kept.feed(s.forces,
                     s.crowd(*others).passes(flown.watched().exposures(network, draw), draw),
                     flown.from(), flown.to());
         else
           kept.feed(flown.watched().passes(network, draw), flown.from(), flown.to());
         return flown.score(kept);
       }))
    f.add(one);
  const double found = std::max(1, f.found);
  print("_manoeuvres", f.logged, "1");
  print("_manoeuvres_found", double(f.found) / std::max(1, f.logged), "1", 0.9, false);
  print("_manoeuvres_others", f.other, "1");
  print("_found_after_h", f.delay_s / found / 3600, "h", 12);
  print("_time_off_s", f.off_s / found, "s");
  print("_time_nees", f.time_d2 / found, "1");
  print("_size_off_m_per_s", f.off_m_per_s / found, "m/s");
  print("_size_nees", f.size_d2 / found, "1");
}

}  // namespace

int bench_catalogue(bool json) {
  const char* root = std::getenv("DMISE_DATA");
  if (!root) {
    std::fputs("dmise bench catalogue: orbits are compared with data in $DMISE_DATA\n", stderr);
    return 0;
  }
  constexpr int seeds = 4;
  const std::vector<MeanElements> others =
      read_catalogue(catalogue_of_18470(std::filesystem::temp_directory_path()).path,
                     {.lenient = true})
          .elements;
  for (const SatelliteDays& of : satellites) {
    const WatchedSatellite s(root, of);
    const std::string name = std::string("kept_") + of.name;
    bench_days(s, spread(wide_network()), yesterday_days, seeds, Printer(name + "_day", json));
    bench_days(s, spread(wide_network()), old_days, 1, Printer(name + "_day_old", json));
    bench_days(s, spread(survey_network()), yesterday_days, 1, Printer(name + "_day_survey", json));
    bench_crowd(s, others, yesterday_days, seeds, {}, Printer(name + "_crowd", json));
    bench_crowd(s, others, old_days, 1, {}, Printer(name + "_crowd_old", json));
    bench_crowd(s, others, old_days, 1, {.rates = false},
                Printer(name + "_crowd_old_directions", json));
    bench_quiet(s, seeds, Printer(name, json));
    bench_manoeuvres(s, root, nullptr, Printer(name, json));
    bench_manoeuvres(s, root, &others, Printer(name + "_crowd", json));
  }
  return 0;
}

}  // namespace dmise
