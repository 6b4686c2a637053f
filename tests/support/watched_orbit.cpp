#include "tests/support/watched_orbit.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/frames/earth_orientation.h"
#include "core/sky/bodies/shadow.h"
#include "core/tracking/line_of_light.h"

namespace dmise {
namespace {

constexpr double grid_s = 30.0;
constexpr double gap_s = 900.0;                 // between passes
const double night_sine = std::sin(-12 * deg);  // sine of the Sun's elevation

struct NamedSite {
  std::string name;
  Site site;
};

/// All-sky cameras at all sites, telescopes at some.
std::vector<OrbitWatcher> network(const std::vector<NamedSite>& sites,
                                  const std::vector<std::string>& with_telescope) {
  std::vector<OrbitWatcher> out;
  for (const NamedSite& s : sites)
    out.push_back({.name = s.name,
                   .site = s.site,
                   .sigma_rad = 20 * arcsec,
                   .limiting_magnitude = 7,
                   .min_elevation_rad = 20 * deg});
  for (const NamedSite& s : sites)
    if (std::ranges::find(with_telescope, s.name) != with_telescope.end())
      out.push_back({.name = s.name + "-telescope",
                     .site = s.site,
                     .sigma_rad = 1 * arcsec,
                     .limiting_magnitude = 14,
                     .min_elevation_rad = 20 * deg,
                     .most_of_a_pass = 3,
                     .exposure_s = 2,
                     .half_angle_rad = 0.5 * deg});
  return out;
}

}  // namespace

std::vector<OrbitWatcher> wide_network() {
  return network({{"svalbard", {78.15, 16.04, 520}},
                  {"poker-flat", {65.13, -147.49, 200}},
                  {"la-palma", {28.758333, -17.88, 2327}},
                  {"wise", {30.59739, 34.76218, 875}},
                  {"mount-john", {-43.987, 170.465, 1029}},
                  {"siding-spring", {-31.273361, 149.061194, 1149}},
                  {"sutherland", {-32.375823, 20.810808, 1798}},
                  {"cerro-tololo", {-30.165278, -70.815, 2215}}},
                 {"la-palma", "mount-john"});
}

std::vector<OrbitWatcher> survey_network() {
  return network({{"haleakala", {20.71552, -156.169, 3048}},
                  {"la-palma", {28.758333, -17.88, 2327}},
                  {"siding-spring", {-31.273361, 149.061194, 1149}},
                  {"sutherland", {-32.375823, 20.810808, 1798}},
                  {"cerro-tololo", {-30.165278, -70.815, 2215}},
                  {"mcdonald", {30.671667, -104.021667, 2075}},
                  {"xinglong", {40.393333, 117.575, 950}},
                  {"wise", {30.59739, 34.76218, 875}}},
                 {"la-palma", "siding-spring"});
}

WatchedOrbit::WatchedOrbit(const Clock& clock, const Truth& truth, SimTime from, SimTime to,
                           const DiffuseSphere& sphere)
    : sphere_(sphere) {
  const EarthSurroundings surroundings(clock, from.seconds(), to.seconds());
  for (SimTime t = from; t <= to; t = t + sim_seconds(grid_s)) {
    const EarthSurroundings::At now = surroundings.at(t.seconds());
    const MotionState<Gcrs> state = truth(t);
    const EarthShadow shadow(now.sun_m, {.pole = now.pole});
    instants_.push_back({t, state, now.itrs_from_gcrs.inverse(), now.sun_m,
                         shadow.sunlit_fraction(state.position_m) > 0.5});
  }
}

bool WatchedOrbit::sees(const OrbitWatcher& watcher, const Instant& now) const {
  const Vec<Gcrs> here = now.gcrs_from_itrs * itrs_from_geodetic(watcher.site);
  const Vec<Gcrs> line = now.state.position_m - here, up = unit(here);
  const double range_m = norm(line);
  if (!now.lit || dot(line, up) < range_m * std::sin(watcher.min_elevation_rad) ||
      dot(unit(now.sun_m), up) > night_sine)
    return false;
  const double phase_rad = angle_rad(now.sun_m - now.state.position_m, -line);
  return diffuse_sphere_magnitude(sphere_, {.range_m = range_m, .phase_rad = phase_rad}) <
         watcher.limiting_magnitude;
}

SeenMotion drawn_motion(const OrbitWatcher& watcher, SimTime time, const Vec<Gcrs>& sensor_m,
                        const Vec<Gcrs>& sensor_m_per_s, const MotionState<Gcrs>& object,
                        const RngKey& key, std::uint32_t draw) {
  const double variance = watcher.sigma_rad * watcher.sigma_rad;
  SeenMotion out{{.time = time, .sensor_m = sensor_m}};
  out.rate_sigma_rad_per_s = std::sqrt(2.0) * watcher.sigma_rad / watcher.exposure_s;
  const LineOfLight line = line_of_light(eigen_of(object.position_m),
                                         eigen_of(object.velocity_m_per_s), eigen_of(sensor_m));
  const Vec<Gcrs> direction = gcrs_of(line.line_m / line.range_m);
  const SkyTangents tangents = sky_tangents(direction);
  const auto scattered = [&](const Vec<Gcrs>& about, double sigma, std::uint32_t word) {
    return about + sigma * normal_of(rng_word(key, draw, word)) * tangents.east +
           sigma * normal_of(rng_word(key, draw, word + 1)) * tangents.north;
  };
  const Vec<Gcrs> motion = gcrs_of(line.velocity_m_per_s) - sensor_m_per_s;
  out.rate_rad_per_s = scattered((motion - direction * dot(motion, direction)) / line.range_m,
                                 out.rate_sigma_rad_per_s, 3);
  AngleObservation& seen = out.observation;
  seen.direction = unit(scattered(direction, watcher.sigma_rad, 1));
  seen.covariance_rad2 = {variance, 0, variance};
  seen.sensor = watcher.name;
  seen.sensor_m_per_s = sensor_m_per_s;
  return out;
}

std::vector<std::size_t> WatchedOrbit::looks(const OrbitWatcher& watcher) const {
  std::vector<std::size_t> out, pass;
  const auto end_pass = [&] {
    const std::size_t all = pass.size(), wanted = std::size_t(watcher.most_of_a_pass);
    if (all <= wanted)
      out.insert(out.end(), pass.begin(), pass.end());
    else if (watcher.spread)
      for (std::size_t k = 0; k < wanted; ++k) out.push_back(pass[k * (all - 1) / (wanted - 1)]);
    else
      out.insert(out.end(), pass.begin(), pass.begin() + long(wanted));
    pass.clear();
  };
  for (std::size_t i = 0; i < instants_.size(); ++i) {
    if (!sees(watcher, instants_[i])) continue;
    if (!pass.empty() && (instants_[i].time - instants_[pass.back()].time).seconds() > gap_s)
      end_pass();
    pass.push_back(i);
  }
  end_pass();
  return out;
}

std::vector<WatchedExposure> WatchedOrbit::exposures(const std::vector<OrbitWatcher>& watchers,
                                                     const Draw& draw) const {
  std::vector<WatchedExposure> out;
  for (const OrbitWatcher& watcher : watchers) {
    const RngKey key = rng_key(draw.seed, watcher.name, 0, "watched orbit");
    for (const std::size_t i : looks(watcher)) {
      const Instant& now = instants_[i];
      WatchedExposure e;
      e.watcher = &watcher;
      e.number = std::uint32_t(i);
      e.time = now.time;
      e.sensor_m = now.gcrs_from_itrs * itrs_from_geodetic(watcher.site);
      e.sensor_m_per_s = cross(Vec<Gcrs>{0, 0, earth_turn_rad_per_s}, e.sensor_m);
      e.sun_m = now.sun_m;
      e.direction = unit(now.state.position_m - e.sensor_m);
      if (uniform_of(rng_word(key, e.number, 0)) <= draw.detection_probability) {
        e.seen =
            drawn_motion(watcher, now.time, e.sensor_m, e.sensor_m_per_s, now.state, key, e.number);
        e.seen->observation.detection_id = watcher.name + "/" + std::to_string(i) + "/0";
      }
      out.push_back(std::move(e));
    }
  }
  std::ranges::stable_sort(out, {}, &WatchedExposure::time);
  return out;
}

std::vector<std::vector<AngleObservation>> WatchedOrbit::passes(
    const std::vector<OrbitWatcher>& watchers, const Draw& draw) const {
  std::vector<std::vector<AngleObservation>> out;
  for (WatchedExposure& e : exposures(watchers, draw)) {
    if (!e.seen) continue;
    if (out.empty() || (e.time - out.back().back().time).seconds() > gap_s) out.emplace_back();
    out.back().push_back(std::move(e.seen->observation));
  }
  return out;
}

}  // namespace dmise
