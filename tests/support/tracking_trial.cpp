#include "tests/support/tracking_trial.h"

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/tracking/propagate.h"

namespace dmise {

namespace {

constexpr double earth_m = 6371e3;

/// Deviates of one trial, one after the other.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : key_(rng_key(seed, "tracking", 0, "trial")) {}
  double uniform() { return uniform_of(rng_word(key_, count_++, 0)); }
  double normal() { return normal_of(rng_word(key_, count_++, 1)); }

 private:
  RngKey key_;
  std::uint32_t count_ = 0;
};

OrbitState moved(const ForceModel& forces, const OrbitState& state, SimTime to) {
  PropagationSettings exact;
  exact.position_tolerance_m = 1e-7;
  const auto there = propagate(forces, state, to, exact);
  if (!there) throw Error(std::string("tracking trial: ") + std::string(there.reason));
  return *there;
}

}  // namespace

Vec<Gcrs> turned_site(double latitude_rad, double longitude_rad, SimTime time) {
  const double turn = longitude_rad + 7.292115146706979e-5 * time.seconds();
  return earth_m * from_spherical<Gcrs>(turn, latitude_rad);
}

AngleObservation observe(const ForceModel& forces, const OrbitState& truth, SimTime time,
                         const Vec<Gcrs>& sensor_m) {
  const OrbitState now = moved(forces, truth, time);
  double light_s = norm(now.position_m - sensor_m) / speed_of_light_m_per_s;
  Vec<Gcrs> line;
  for (int i = 0; i < 4; ++i) {
    // What is left of the nanosecond is added with the velocity.
    const SimTime then = time - sim_seconds(light_s);
    const OrbitState left = moved(forces, now, then);
    const double rest_s = (time - then).seconds() - light_s;
    line = left.position_m + left.velocity_m_per_s * rest_s - sensor_m;
    light_s = norm(line) / speed_of_light_m_per_s;
  }
  AngleObservation out;
  out.time = time;
  out.sensor_m = sensor_m;
  out.direction = unit(line);
  return out;
}

TrackingTrial tracking_trial(const ForceModel& forces, const TrialSettings& s, std::uint64_t seed) {
  Dice dice(seed);
  const double latitude = (dice.uniform() - 0.5) * 100 * deg,
               longitude = dice.uniform() * 360 * deg;
  const double heading = dice.uniform() * 360 * deg;
  const double height = s.height_m * (1 + s.height_scatter * (2 * dice.uniform() - 1));
  const double eccentricity = 0.02 * dice.uniform();
  const double span_s = s.cadence_s * (s.exposures - 1);
  const SimTime middle = sim_seconds(std::round(span_s / 2));

  // Over a point near the middle site at the middle of the pass.
  const Vec<Gcrs> up = unit(turned_site(latitude + (dice.uniform() - 0.5) * 4 * deg,
                                        longitude + (dice.uniform() - 0.5) * 4 * deg, middle));
  const Vec<Gcrs> east = unit(cross(Vec<Gcrs>{0, 0, 1}, up)), north = cross(up, east);
  const double r = earth_m + height;
  OrbitState over{middle, r * up,
                  std::sqrt(earth_gm_m3_per_s2 / r * (1 + eccentricity)) *
                      (std::cos(heading) * north + std::sin(heading) * east)};
  over.drag_m2_per_kg = s.drag_m2_per_kg;
  TrackingTrial out;
  out.truth = moved(forces, over, SimTime{});

  for (int k = 0; k < s.exposures; ++k) {
    const SimTime time = sim_seconds(k * s.cadence_s);
    for (int site = 0; site < s.sites; ++site) {
      // The second site is east of the first, the third north of it, and so on around.
      const double turn = site * 90 * deg, step = site ? s.baseline_m / earth_m : 0.0;
      const Vec<Gcrs> place =
          turned_site(latitude + step * std::sin(turn - 90 * deg),
                      longitude + step * std::cos(turn - 90 * deg) / std::cos(latitude), time);
      AngleObservation seen = observe(forces, out.truth, time, place);
      const SkyTangents tangents = sky_tangents(seen.direction);
      seen.direction = unit(seen.direction + s.sigma_rad * dice.normal() * tangents.east +
                            s.sigma_rad * dice.normal() * tangents.north);
      seen.covariance_rad2 = {s.sigma_rad * s.sigma_rad, 0, s.sigma_rad * s.sigma_rad};
      seen.sensor = "site" + std::to_string(site);
      seen.detection_id = seen.sensor + "/" + std::to_string(k + 1) + "/0";
      out.observations.push_back(seen);
    }
  }
  return out;
}

}  // namespace dmise
