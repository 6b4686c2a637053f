#include "tests/support/watched_orbit.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"
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
                     .most_of_a_pass = 3});
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

std::vector<std::vector<AngleObservation>> WatchedOrbit::passes(
    const std::vector<OrbitWatcher>& watchers, const Draw& draw) const {
  std::vector<AngleObservation> all;
  for (const OrbitWatcher& watcher : watchers) {
    const RngKey key = rng_key(draw.seed, watcher.name, 0, "watched orbit");
    const double variance = watcher.sigma_rad * watcher.sigma_rad;
    int of_pass = 0;
    double last_s = -1e9;
    for (std::size_t i = 0; i < instants_.size(); ++i) {
      const Instant& now = instants_[i];
      if (!sees(watcher, now)) continue;
      if (now.time.seconds() - last_s > gap_s) of_pass = 0;
      last_s = now.time.seconds();
      const std::uint32_t n = std::uint32_t(i);
      if (++of_pass > watcher.most_of_a_pass ||
          uniform_of(rng_word(key, n, 0)) > draw.detection_probability)
        continue;
      AngleObservation seen{.time = now.time,
                            .sensor_m = now.gcrs_from_itrs * itrs_from_geodetic(watcher.site)};
      const LineOfLight line =
          line_of_light(eigen_of(now.state.position_m), eigen_of(now.state.velocity_m_per_s),
                        eigen_of(seen.sensor_m));
      const Vec<Gcrs> direction = gcrs_of(line.line_m / line.range_m);
      const SkyTangents tangents = sky_tangents(direction);
      seen.direction =
          unit(direction + watcher.sigma_rad * normal_of(rng_word(key, n, 1)) * tangents.east +
               watcher.sigma_rad * normal_of(rng_word(key, n, 2)) * tangents.north);
      seen.covariance_rad2 = {variance, 0, variance};
      seen.sensor = watcher.name;
      seen.detection_id = watcher.name + "/" + std::to_string(i) + "/0";
      all.push_back(std::move(seen));
    }
  }
  std::ranges::stable_sort(all, {}, &AngleObservation::time);
  std::vector<std::vector<AngleObservation>> out;
  for (AngleObservation& o : all) {
    if (out.empty() || (o.time - out.back().back().time).seconds() > gap_s) out.emplace_back();
    out.back().push_back(std::move(o));
  }
  return out;
}

}  // namespace dmise
