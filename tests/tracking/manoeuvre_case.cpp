// Watches paths that another program has integrated, keeps their objects by what is seen, and
// writes the manoeuvres that this finds, for tests/reference/manoeuvres_with_scipy.py.
//
// Standard input: START_UTC, then for each path `SEED NETWORK STEP_S COUNT` and COUNT lines of a
// state in GCRS [m, m/s] from the start on. Standard output: a line of JSON for each path.
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/time/iso8601.h"
#include "core/tracking/maintenance/catalogue_object.h"
#include "tests/support/watched_orbit.h"

namespace dmise {
namespace {

constexpr double max_arc_s = 1800.0;  // as the fusion node ends arcs
constexpr int gravity_degree = 4;     // as the paths have it
const OrbitVector prior_sigma =
    (OrbitVector() << 700, 700, 700, 0.5, 0.5, 0.5, 0, 0.003).finished();

struct KnownPath {
  unsigned seed = 0;
  std::string network;
  double step_s = 0.0;
  std::vector<MotionState<Gcrs>> states;

  SimTime end() const { return sim_seconds(step_s * double(states.size() - 2)); }

  /// By the cubic through states: 1 cm with states 30 s apart.
  MotionState<Gcrs> at(SimTime time) const {
    const auto k = std::size_t(time.seconds() / step_s);
    const MotionState<Gcrs>&a = states[k], &b = states[k + 1];
    const double h = step_s, s = time.seconds() / h - double(k), r = 1 - s;
    return {(1 + 2 * s) * r * r * a.position_m + s * r * r * h * a.velocity_m_per_s +
                s * s * (3 - 2 * s) * b.position_m - s * s * r * h * b.velocity_m_per_s,
            6 * s * r / h * (b.position_m - a.position_m) + r * (1 - 3 * s) * a.velocity_m_per_s +
                s * (3 * s - 2) * b.velocity_m_per_s};
  }
};

bool read(std::istream& in, KnownPath& path) {
  std::size_t count = 0;
  if (!(in >> path.seed >> path.network >> path.step_s >> count)) return false;
  path.states.resize(count);
  for (MotionState<Gcrs>& s : path.states) {
    auto& r = s.position_m;
    auto& v = s.velocity_m_per_s;
    if (!(in >> r.x >> r.y >> r.z >> v.x >> v.y >> v.z)) throw Error("a path is cut off");
  }
  return true;
}

constexpr double belt_cadence_s = 600.0;

/// Three telescopes that look at the geostationary belt; of their exposures one in ten minutes.
std::vector<OrbitWatcher> belt_network() {
  std::vector<OrbitWatcher> out;
  for (const auto& [name, site] : {std::pair("la-palma", Site{28.758333, -17.88, 2327}),
                                   std::pair("wise", Site{30.59739, 34.76218, 875}),
                                   std::pair("sutherland", Site{-32.375823, 20.810808, 1798})})
    out.push_back({.name = name,
                   .site = site,
                   .sigma_rad = 1 * arcsec,
                   .limiting_magnitude = 16,
                   .cadence_s = belt_cadence_s,
                   .min_elevation_rad = 20 * deg,
                   .exposure_s = 5});
  return out;
}

std::vector<std::vector<AngleObservation>> arcs_of(const WatchedOrbit& watched,
                                                   const KnownPath& path) {
  const bool belt = path.network == "belt";
  const auto network = belt ? belt_network() : wide_network();
  std::vector<std::vector<AngleObservation>> out;
  for (const auto& pass : watched.passes(network, {.seed = path.seed})) {
    bool is_new = true;
    for (const AngleObservation& seen : pass) {
      if (belt && std::fmod(seen.time.seconds(), belt_cadence_s) != 0) continue;
      if (is_new || (seen.time - out.back().front().time).seconds() > max_arc_s) out.emplace_back();
      is_new = false;
      out.back().push_back(seen);
    }
  }
  return out;
}

OrbitEstimate believed_about(const MotionState<Gcrs>& truth, unsigned seed) {
  OrbitEstimate out{{SimTime{}, truth.position_m, truth.velocity_m_per_s}};
  const RngKey key = rng_key(seed, "prior", 0, "manoeuvre case");
  OrbitVector off;
  for (int i = 0; i < orbit_size; ++i)
    off[i] = prior_sigma[i] * normal_of(rng_word(key, std::uint32_t(i), 0));
  out.state = state_of(vector_of(out.state) + off, SimTime{});
  out.covariance = prior_sigma.array().square().matrix().asDiagonal();
  return out;
}

template <class M>
void write_guess(JsonWriter& json, const M& m) {
  const Vec<Rtn>& v = m.change.delta_v_m_per_s;
  json.field("time_s", m.change.time.seconds()).field("time_sigma_s", m.time_sigma_s);
  json.key("delta_v_m_per_s").begin_array().value(v.x).value(v.y).value(v.z).end_array();
  json.key("covariance").begin_array();
  for (int i = 0; i < 9; ++i) json.value(m.covariance(i / 3, i % 3));
  json.end_array();
}

void write(JsonWriter& json, const char* key, const std::vector<FoundManoeuvre>& all) {
  json.key(key).begin_array();
  for (const FoundManoeuvre& m : all) {
    json.begin_object().field("found_s", m.found.seconds());
    write_guess(json, m);
    json.key("modes").begin_array();
    for (const ManoeuvreMode& mode : m.modes) {
      json.begin_object().field("chance", mode.chance);
      write_guess(json, mode);
      json.end_object();
    }
    json.end_array().end_object();
  }
  json.end_array();
}

std::string found_of(const MaintenanceForces& forces, const KnownPath& path) {
  const WatchedOrbit watched(forces.clock(), [&](SimTime t) { return path.at(t); }, SimTime{},
                             path.end(), {.radius_m = 2, .albedo = 0.3});
  CatalogueObject object(forces, believed_about(path.states.front(), path.seed));
  std::vector<FoundManoeuvre> at_first;
  std::size_t detections = 0;
  for (const auto& arc : arcs_of(watched, path)) {
    detections += arc.size();
    const auto news = object.take(arc);
    if (!news) throw Error(std::string(news.reason));
    if (news->manoeuvre) at_first.push_back(*news->manoeuvre);
  }
  JsonWriter json;
  json.begin_object().field("detections", double(detections));
  write(json, "at_first", at_first);
  write(json, "at_last", object.manoeuvres());
  json.key("end").begin_object();
  const auto end = object.estimate_at(path.end());
  const MotionState<Gcrs> truth = path.at(path.end());
  if (end)
    json.field("off_m", norm(end->state.position_m - truth.position_m))
        .field("nees", nees(*end, {path.end(), truth.position_m, truth.velocity_m_per_s}) / 6);
  json.end_object();
  return json.end_object().take();
}

int run() {
  std::string start;
  std::cin >> start;
  const Clock clock(parse_utc(start));
  MaintenanceSettings settings;
  settings.gravity_degree = gravity_degree;
  const MaintenanceForces forces(clock, SimTime{}, sim_seconds(4 * 86400.0), settings);
  for (KnownPath path; read(std::cin, path);) {
    std::puts(found_of(forces, path).c_str());
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace dmise

int main() try { return dmise::run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "manoeuvre-case: %s\n", error.what());
  return 1;
}
