#include "core/visibility/passes.h"

#include <algorithm>
#include <cmath>

#include "core/sky/air/air_exposure.h"
#include "core/visibility/batch_states.h"

namespace dmise {
namespace {

constexpr double top_error_s = 0.05;

/// Position of one object relative to the camera at one instant.
struct Place {
  CameraMoment camera;
  Sgp4State state;

  SimTime time() const { return camera.time; }
  bool ok() const { return camera.there && state.code == Sgp4Code::ok; }
  Vec<Teme> line_m() const { return state.position_m - camera.apex_m; }
  double range_m() const { return ok() ? norm(line_m()) : 1e300; }
};

/// Index of the first place at which `value` is greatest.
template <class Value>
std::size_t greatest(const std::vector<Place>& places, const Value& value) {
  return std::size_t(std::ranges::max_element(places, {}, value) - places.begin());
}

/// Evaluates one object relative to a sensor at any instant.
class Follower {
 public:
  Follower(const Sgp4Batch& batch, const SensorTrack& track, const Sight& sight,
           std::uint32_t object)
      : batch_(batch), track_(track), sight_(sight), object_(object) {}

  std::vector<Place> along(const std::vector<SimTime>& times) const {
    const std::size_t n = times.size();
    std::vector<Place> places(n);
    std::vector<double> minutes(n), position(3 * n), velocity(3 * n);
    std::vector<std::uint8_t> code(n);
    for (std::size_t k = 0; k < n; ++k) {
      places[k].camera = track_.at(times[k]);
      const Utc& utc = places[k].camera.utc;
      minutes[k] = batch_.minutes_since_epoch(object_, utc.jd1, utc.jd2);
    }
    batch_.propagate_times(object_, minutes, position, velocity, code);
    for (std::size_t k = 0; k < n; ++k)
      places[k].state = {BatchStates::vec(position, k), BatchStates::vec(velocity, k),
                         static_cast<Sgp4Code>(code[k])};
    return places;
  }

  bool visible(const Place& p) const {
    return p.ok() && sight_.visible(p.camera, p.state.position_m);
  }
  /// Whether exposures are flagged, not lost, where a body is too near the axis.
  bool is_flagged() const {
    return track_.sensor().camera.exclusion.action == ExclusionAction::flag;
  }
  bool lit(const Place& p) const { return sunlit(p) >= lit_fraction; }
  double sunlit(const Place& p) const {
    return p.ok() ? Sunlight(track_.sky(), p.time()).fraction(p.state.position_m) : 0.0;
  }
  /// Maximal at the top of a pass.
  double height(const Place& p) const {
    if (!p.ok()) return -1e300;
    return track_.site() ? dot(p.camera.up, p.line_m()) / p.range_m() : -p.range_m();
  }
  double sun_elevation_rad(const CameraMoment& camera) const {
    const Sunlight light(track_.sky(), camera.time);
    const Vec<Gcrs> to_sun = light.sun_m() - light.gcrs_from_teme() * camera.apex_m;
    return elevation_over(light.gcrs_from_teme() * camera.up, unit(to_sun));
  }

  PassMoment moment(SimTime t) const {
    constexpr std::int64_t half_ns = 50'000'000;
    const auto places = along({{t.ns - half_ns}, t, {t.ns + half_ns}});
    const Place &a = places[0], &p = places[1], &b = places[2];
    PassMoment m{.time = t};
    if (track_.site()) m.sun_elevation_rad = sun_elevation_rad(p.camera);
    if (!p.ok()) return m;
    m.range_m = p.range_m();
    m.sunlit = sunlit(p);
    if (a.ok() && b.ok())
      m.rate_rad_per_s = angle_rad(a.camera.from_camera_m(a.state.position_m),
                                   b.camera.from_camera_m(b.state.position_m)) /
                         (2e-9 * double(half_ns));
    if (track_.site())
      m.horizontal = horizontal(enu_from_itrs(*track_.site()) *
                                (track_.sky().earth(t).itrs_from_teme(t) * p.line_m()));
    return m;
  }

  /// The instant at which `test` changes between two instants for which it differs.
  template <class Test>
  SimTime turning(SimTime a, SimTime b, bool at_a, Test&& test) const {
    while ((b - a).seconds() > event_error_s) {
      const auto times = between(a, b);
      const auto places = along(times);
      std::size_t k = 0;
      while (k < places.size() && test(places[k]) == at_a) ++k;
      if (k < places.size()) b = times[k];
      if (k > 0) a = times[k - 1];
    }
    return {a.ns + (b.ns - a.ns) / 2};
  }

  /// The instant of the maximum of `value` between two instants around it.
  template <class Value>
  Place peak(SimTime a, SimTime b, Value&& value) const {
    for (;;) {
      const auto times = between(a, b);
      auto places = along(times);
      const std::size_t best = greatest(places, value);
      if ((b - a).seconds() < top_error_s) return places[best];
      if (best > 0) a = times[best - 1];
      if (best + 1 < times.size()) b = times[best + 1];
    }
  }

 private:
  /// Evenly spaced instants inside, as many as the propagator computes at once.
  static std::vector<SimTime> between(SimTime a, SimTime b) {
    constexpr int parts = 17;
    std::vector<SimTime> times;
    for (int k = 1; k < parts; ++k) times.push_back({a.ns + (b.ns - a.ns) * k / parts});
    return times;
  }

  const Sgp4Batch& batch_;
  const SensorTrack& track_;
  const Sight& sight_;
  std::uint32_t object_;
};

/// Instants along a pass, ends included: at least 17, no closer than 10 s beyond them and at most
/// some 1500.
std::vector<SimTime> instants_along(SimTime rise, SimTime set) {
  const double length_s = (set - rise).seconds();
  const double spacing_s = std::min(length_s / 16.0, std::max(10.0, length_s / 1500.0));
  const int count = length_s > 0 ? int(std::ceil(length_s / spacing_s)) : 1;
  std::vector<SimTime> times;
  for (int k = 0; k <= count; ++k)
    times.push_back({rise.ns + std::llround(double(set.ns - rise.ns) * k / count)});
  return times;
}

/// Finds the sunlit time from positions along the pass.
void find_light(const Follower& object, const std::vector<Place>& places, Pass& pass) {
  bool was_lit = false;
  SimTime since{};
  const auto ends = [&](SimTime t) {
    pass.lit_to = t;
    pass.lit_s += (t - since).seconds();
  };
  const auto is_lit = [&](const Place& p) { return object.lit(p); };
  for (std::size_t k = 0; k < places.size(); ++k) {
    const SimTime t = places[k].time();
    const bool lit = is_lit(places[k]);
    if (lit && !was_lit) {
      since = k == 0 ? t : object.turning(places[k - 1].time(), t, false, is_lit);
      if (!pass.lit_from) pass.lit_from = since;
    }
    if (!lit && was_lit) ends(object.turning(places[k - 1].time(), t, true, is_lit));
    if (lit && k + 1 == places.size()) ends(t);
    was_lit = lit;
  }
}

/// Computes a pass from its rise and set.
void describe(const Follower& object, SimTime rise, SimTime set, Pass& pass) {
  const auto places = object.along(instants_along(rise, set));
  find_light(object, places, pass);
  pass.excluded = object.is_flagged() && std::ranges::any_of(places, [](const Place& p) {
                    return p.camera.excluded.any();
                  });
  const auto peak = [&](auto&& value) {
    const std::size_t best = greatest(places, value);
    const SimTime a = places[best > 0 ? best - 1 : 0].time();
    const SimTime b = places[std::min(best + 1, places.size() - 1)].time();
    const Place inner = object.peak(a, b, value);
    return value(inner) > value(places[best]) ? inner : places[best];
  };
  pass.rise = object.moment(rise);
  pass.top = object.moment(peak([&](const Place& p) { return object.height(p); }).time());
  pass.set = object.moment(set);
  pass.min_range_m = peak([](const Place& p) { return -p.range_m(); }).range_m();
  if (!pass.top.sun_elevation_rad) return;
  pass.min_sun_elevation_rad = *pass.top.sun_elevation_rad;
  for (std::size_t k = 0; k <= 16; ++k)
    pass.min_sun_elevation_rad =
        std::min(pass.min_sun_elevation_rad,
                 object.sun_elevation_rad(places[(places.size() - 1) * k / 16].camera));
}

}  // namespace

std::vector<Pass> passes_of(const Sgp4Batch& batch, const SensorTrack& track,
                            const std::vector<VisibilityInterval>& intervals, Threads& threads) {
  const Sight sight(track.sensor());
  std::vector<Pass> passes(intervals.size());
  threads.for_ranges(intervals.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const VisibilityInterval& interval = intervals[k];
      const Follower object(batch, track, sight, interval.object);
      const auto visible = [&](const Place& p) { return object.visible(p); };
      Pass& pass = passes[k];
      pass.object = interval.object;
      pass.open_start = interval.open_start;
      pass.open_end = interval.open_end;
      SimTime rise = interval.in_first, set = interval.in_last;
      if (!interval.open_start) rise = object.turning(interval.out_before, rise, false, visible);
      if (!interval.open_end) set = object.turning(set, interval.out_after, true, visible);
      describe(object, rise, set, pass);
    }
  });
  return passes;
}

}  // namespace dmise
