#include "bench/bench_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/figure.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/orbit/motion.h"
#include "core/orbit/sp3.h"
#include "tests/support/flights.h"

namespace dmise {
namespace {

const char* data_root() {
  const char* root = std::getenv("DMISE_DATA");
  return root ? root : "../shared/data";
}

std::string finals() { return std::string(data_root()) + "/eop/finals2000A.all.gz"; }

void bench_orekit(bool json) {
  const Clock clock = test::orekit_clock(finals());
  for (const auto& flight : test::orekit_flights) {
    const std::string name = flight.name;
    if (name == "hyperbola") continue;  // beyond the Moon, whose place is worth a kilometre
    const NumericalPath path =
        integrate_flight(test::forces_of(flight, clock), test::flight_of(flight));
    double worst_m = 0;
    for (int i = 0; i < 4; ++i)
      worst_m = std::max(worst_m, norm(test::on_path(path, clock, 21600.0 * (i + 1)).position_m -
                                       flight.every_six_hours[i].position_m));
    print_figure({.name = "flight_orekit_" + name + "_m",
                  .value = worst_m,
                  .unit = "m",
                  .anchor = "Orekit 13.1, a day, the same forces",
                  .target = 1.0,
                  .less_is_better = true},
                 json);
  }
}

/// A precise orbit, and flights from its first state.
class PreciseOrbit {
 public:
  PreciseOrbit(const std::string& file, const std::string& start)
      : clock_(parse_utc(start),
               std::make_shared<const IersTable>(IersTable::read_finals2000a(finals()))),
        orbit_(read_sp3(std::string(data_root()) + "/validation/orbits/" + file)),
        surroundings_(std::make_shared<const EarthSurroundings>(clock_, 0.0, day_s)) {}

  /// Residuals at every 10 minutes of a flight from time 0 to `to_s`: three a time [m].
  std::vector<double> residuals(double drag, double radiation, double to_s) const {
    const FlightForces forces(surroundings_, {.gravity_degree = 70,
                                              .sun_moon = true,
                                              .drag_m2_per_kg = drag,
                                              .radiation_m2_per_kg = radiation});
    const NumericalPath path =
        integrate_flight(forces, {.state = truth(0), .from_s = 0, .to_s = to_s});
    std::vector<double> out;
    for (double t = 600; t <= to_s; t += 600) {
      const Vec<Gcrs> d = test::on_path(path, clock_, t).position_m - truth(t).position_m;
      out.insert(out.end(), {d.x, d.y, d.z});
    }
    return out;
  }

  /// Drag and radiation scales [m^2/kg] that fit the first `to_s` best; neither is negative.
  std::array<double, 2> fitted(double to_s) const {
    std::array<double, 2> at{0.01, 0.01};
    for (int round = 0; round < 4; ++round) {
      const auto here = residuals(at[0], at[1], to_s);
      const double h = 1e-3;
      const auto by_drag = residuals(at[0] + h, at[1], to_s);
      const auto by_light = residuals(at[0], at[1] + h, to_s);
      double aa = 0, ab = 0, bb = 0, ra = 0, rb = 0;
      for (std::size_t i = 0; i < here.size(); ++i) {
        const double a = (by_drag[i] - here[i]) / h, b = (by_light[i] - here[i]) / h;
        aa += a * a, ab += a * b, bb += b * b, ra += a * here[i], rb += b * here[i];
      }
      const double det = aa * bb - ab * ab;
      at = {std::max(1e-6, at[0] - (ra * bb - rb * ab) / det),
            std::max(1e-6, at[1] - (rb * aa - ra * ab) / det)};
    }
    return at;
  }

 private:
  static constexpr double day_s = 86400.0;

  MotionState<Gcrs> truth(double time_s) const {
    const SimTime time = sim_seconds(time_s);
    return in_gcrs(state_at(orbit_, clock_.tai(time)), earth_orientation(clock_, time), time);
  }

  Clock clock_;
  Trajectory orbit_;
  std::shared_ptr<const EarthSurroundings> surroundings_;
};

double rms_m(const std::vector<double>& residuals) {
  double sum = 0;
  for (const double r : residuals) sum += r * r;
  return std::sqrt(3 * sum / double(residuals.size()));
}

/// Days, each from its first state with scales fitted on its first six hours.
void bench_precise(bool json, const std::string& name, const std::string& file,
                   const std::vector<std::string>& starts) {
  std::vector<double> of_day_m;
  for (const std::string& start : starts) {
    const PreciseOrbit orbit(file, start);
    const auto [drag, radiation] = orbit.fitted(6 * 3600.0);
    of_day_m.push_back(rms_m(orbit.residuals(drag, radiation, 86400)));
  }
  std::sort(of_day_m.begin(), of_day_m.end());
  const auto print = [&](const char* which, double value_m) {
    print_figure({.name = "flight_" + name + "_day_rms_" + which + "_m",
                  .value = value_m,
                  .unit = "m",
                  .anchor = "SP3; drag and sunlight fitted on the first 6 h",
                  .target = 30,
                  .less_is_better = true},
                 json);
  };
  print("median", 0.5 * (of_day_m[(of_day_m.size() - 1) / 2] + of_day_m[of_day_m.size() / 2]));
  print("worst", of_day_m.back());
}

/// Days one after another of a month, each at `time`.
std::vector<std::string> days(const std::string& month, int first, int last,
                              const std::string& time) {
  std::vector<std::string> starts;
  for (int day = first; day <= last; ++day)
    starts.push_back(month + (day < 10 ? "-0" : "-") + std::to_string(day) + time);
  return starts;
}

void bench_time(bool json) {
  const Clock clock(parse_utc("2018-12-24T22:00:00"));
  constexpr int objects = 1000;
  constexpr double length_s = 3600, step_s = 5;
  double sum = 0;
  const double seconds = median_seconds(3, [&] {
    const auto surroundings = std::make_shared<const EarthSurroundings>(clock, 0.0, length_s);
    for (int i = 0; i < objects; ++i) {
      const FlightForces forces(surroundings,
                                {.drag_m2_per_kg = 0.022, .radiation_m2_per_kg = 0.013});
      const auto start = state_of(KeplerElements{.periapsis_m = 6.778e6 + 700.0 * i,
                                                 .eccentricity = 0.001,
                                                 .inclination_rad = 1.7 - 0.001 * i,
                                                 .raan_rad = 0.1 * i,
                                                 .true_anomaly_rad = 0.37 * i});
      const NumericalPath path =
          integrate_flight(forces, {.state = start, .from_s = 0, .to_s = length_s});
      const Trajectory trajectory{"", clock.tai({0}), path.segments};
      for (double t = 0; t <= length_s; t += step_s)
        sum += std::get<MotionState<Gcrs>>(state_at(trajectory, clock.tai(sim_seconds(t))))
                   .position_m.x;
    }
  });
  if (!std::isfinite(sum)) throw Error("a flight is not finite");
  print_figure({.name = "flight_1000_objects_1_h_s",
                .value = seconds,
                .unit = "s",
                .target = 2,
                .less_is_better = true},
               json);
}

}  // namespace

int bench_motion(bool json) {
  bench_time(json);
  if (!std::getenv("DMISE_DATA")) {
    std::fputs("dmise bench motion: orbits are compared with data in $DMISE_DATA\n", stderr);
    return 0;
  }
  bench_orekit(json);
  bench_precise(json, "sentinel3a", "sentinel3a.sp3.gz", days("2018-12", 25, 31, "T00:00:00"));
  bench_precise(json, "jason1", "jason1.sp3.gz", days("2003-01", 8, 15, "T06:00:00"));
  return 0;
}

}  // namespace dmise
