// Writes a simulated pass, what core/tracking makes of it, and a path of a day, as JSON for
// tests/reference/orbit_with_scipy.py: tracking-case SEED.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/tracking/filter.h"
#include "core/tracking/initial/initial_orbit.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

template <class T>
T value_of(const Outcome<T>& outcome) {
  if (!outcome) throw Error(std::string(outcome.reason));
  return *outcome;
}

void write(JsonWriter& json, std::string_view key, const Vec<Gcrs>& v) {
  json.key(key).begin_array().value(v.x).value(v.y).value(v.z).end_array();
}

void write(JsonWriter& json, std::string_view key, const OrbitState& state) {
  json.key(key).begin_object().field("time_s", state.time.seconds());
  write(json, "position_m", state.position_m);
  write(json, "velocity_m_per_s", state.velocity_m_per_s);
  json.end_object();
}

void write(JsonWriter& json, std::string_view key, const OrbitEstimate& estimate) {
  json.key(key).begin_object();
  write(json, "state", estimate.state);
  json.key("covariance").begin_array();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) json.value(estimate.covariance(i, j));
  json.end_array().end_object();
}

std::string case_of(unsigned seed) {
  const Clock clock(Utc{2459580.5, 0.0});
  const ForceModel forces(clock, SimTime{});
  const TrackingTrial trial = tracking_trial(forces, {}, seed);
  const auto start = value_of(two_site_orbit(forces, std::span(trial.observations).first(6)));
  FilterSettings settings;
  settings.acceleration_noise_m2_per_s3 = 0;
  OrbitFilter filter(forces, start.estimate, settings);
  for (const AngleObservation& seen : std::span(trial.observations).subspan(6))
    value_of(filter.update(seen));
  const auto fit = value_of(fit_orbit(forces, trial.observations, start.estimate.state));
  JsonWriter json;
  json.begin_object();
  write(json, "pole", forces.surroundings(SimTime{}).pole);
  write(json, "truth", trial.truth);
  write(json, "a_day_later", value_of(propagate(forces, trial.truth, sim_seconds(86400))));
  write(json, "fit", fit.estimate);
  write(json, "filter", filter.estimate());
  json.key("observations").begin_array();
  for (const AngleObservation& o : trial.observations) {
    json.begin_object().field("time_s", o.time.seconds());
    write(json, "sensor_m", o.sensor_m);
    write(json, "direction", o.direction);
    json.field("sigma_rad", std::sqrt(o.covariance_rad2[0])).end_object();
  }
  json.end_array().end_object();
  return json.take();
}

}  // namespace
}  // namespace dmise

int main(int argc, char** argv) {
  try {
    std::puts(dmise::case_of(argc > 1 ? unsigned(std::atoi(argv[1])) : 1).c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "tracking-case: %s\n", e.what());
    return 1;
  }
}
