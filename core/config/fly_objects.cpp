#include "core/config/fly_objects.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/config/make_clock.h"
#include "core/config/stated_motion.h"
#include "core/forces/numerical_flight.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double margin_s = 300.0;                  // about the run: light time, exposures
constexpr double farthest_epoch_s = 100 * 86400.0;  // most between a stated orbit and the run
constexpr double noted_m = 1.0;                     // least error within a tick that is warned of

/// Flies the objects of one scenario.
class Flyer {
 public:
  explicit Flyer(Scenario& scenario)
      : scenario_(scenario),
        clock_(make_clock(scenario)),
        end_s_(scenario.time_of(scenario.last_tick()).seconds()),
        from_s_(-margin_s),
        to_s_(end_s_ + margin_s) {
    double first_s = from_s_, last_s = to_s_;
    for (const OwnObject& object : scenario.own_objects)
      if (object.motion.flight) {
        first_s = std::min(first_s, start_of(object.motion));
        last_s = std::max(last_s, start_of(object.motion));
      }
    surroundings_ = std::make_shared<const EarthSurroundings>(clock_, first_s, last_s);
  }

  void fly(OwnObject& object) {
    FlightConfig& flight = *object.motion.flight;
    flight.stated = object.motion.model;
    NumericalFlight path{.epoch_s = start_of(object.motion),
                         .from_s = from_s_,
                         .to_s = to_s_,
                         .manoeuvres = flight.manoeuvres};
    Trajectory whole{.source = "the flight of " + object.name, .reference = clock_.tai({0})};
    if (flight.numerical) {
      path.state = std::get<TwoBodyMotion>(std::get<MotionModel>(flight.stated)).state;
    } else {
      path.state = state_of_manoeuvre(flight, path.epoch_s);
      whole.segments = before_manoeuvre(flight, path.epoch_s);
      path.from_s = std::max(path.from_s, path.epoch_s);
    }
    if (path.from_s < path.to_s) {
      NumericalPath flown = integrate_flight(FlightForces(surroundings_, flight.forces), path,
                                             {.ellipsoid = scenario_.earth.ellipsoid});
      for (OemSegment& segment : flown.segments) whole.segments.push_back(std::move(segment));
      for (const FlightEnd& end : flown.ends)
        if (whole.segments.empty() || (end.at_s >= 0 && end.at_s <= end_s_)) note_end(flight, end);
    }
    for (OemSegment& segment : whole.segments) segment.object_name = object.name;
    if (whole.segments.empty())
      throw ConfigError(flight.where + ": " + object.name + " has no path in the run" +
                        (flight.end.empty() ? "" : ": " + flight.end));
    if (!flight.end.empty()) whole.source += " (" + flight.end + ")";
    object.motion.model = MotionModel(std::move(whole));
    warn_of_jumps(flight);
  }

 private:
  /// Simulation time of a numerical state's epoch, or of the first manoeuvre.
  double start_of(const MotionConfig& motion) const {
    const FlightConfig& flight = *motion.flight;
    if (!flight.numerical) return flight.manoeuvres.front().at_s;
    const auto& model = std::get<MotionModel>(motion.model);
    const double epoch_s = since_start_s(clock_, std::get<TwoBodyMotion>(model).epoch);
    if (epoch_s < -farthest_epoch_s || epoch_s > end_s_ + farthest_epoch_s)
      throw ConfigError(flight.where + ": numerical: its epoch must be within 100 days of the run");
    if (!flight.manoeuvres.empty() && flight.manoeuvres.front().at_s < epoch_s - 1e-6)
      throw ConfigError(flight.where + ": manoeuvres: the first is before the epoch of the state");
    return epoch_s;
  }

  MotionState<Gcrs> state_of_manoeuvre(const FlightConfig& flight, double at_s) const {
    try {
      const SimTime time = sim_seconds(at_s);
      return in_gcrs(StatedMotion(flight.stated, clock_).at(at_s), earth_orientation(clock_, time),
                     time);
    } catch (const Error& e) {
      throw ConfigError(flight.where + ": has no state at its first manoeuvre: " + e.what());
    }
  }

  std::vector<OemSegment> before_manoeuvre(const FlightConfig& flight, double at_s) const {
    try {
      return StatedMotion(flight.stated, clock_).until(from_s_, std::min(at_s, to_s_));
    } catch (const Error& e) {
      throw ConfigError(flight.where + ": has no state before its first manoeuvre: " + e.what());
    }
  }

  void note_end(FlightConfig& flight, const FlightEnd& end) const {
    flight.end = end.why + " at " + format_utc(clock_.utc(sim_seconds(end.at_s)), 0);
  }

  /// Ticks are joined by polynomials, which round a change of velocity off: by up to 0.15 (cubic),
  /// 0.22 (quintic) and 0.16 (septic) of it times the tick.
  void warn_of_jumps(const FlightConfig& flight) {
    for (const Manoeuvre& m : flight.manoeuvres) {
      const double off_m = norm(m.delta_v_m_per_s) * scenario_.tick.seconds() / 4;
      if (off_m <= noted_m || m.at_s < 0 || m.at_s > end_s_) continue;
      scenario_.warnings.push_back(formatted(
          "%s: manoeuvres: about the tick of the change of %.3g m/s places are up to %.3g m "
          "off; a shorter tick_s lessens it",
          flight.where.c_str(), norm(m.delta_v_m_per_s), off_m));
    }
  }

  Scenario& scenario_;
  Clock clock_;
  double end_s_, from_s_, to_s_;
  std::shared_ptr<const EarthSurroundings> surroundings_;
};

}  // namespace

void fly_objects(Scenario& scenario) {
  const auto flies = [](const OwnObject& object) { return object.motion.flight.has_value(); };
  if (std::ranges::none_of(scenario.own_objects, flies)) return;
  Flyer flyer(scenario);
  for (OwnObject& object : scenario.own_objects)
    if (flies(object)) flyer.fly(object);
}

}  // namespace dmise
