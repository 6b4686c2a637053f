#include "tests/support/watched_crowd.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/orbit/elements/epoch.h"
#include "core/sky/bodies/shadow.h"

namespace dmise {
namespace {

constexpr double crowd_gap_s = 900.0;  // between passes
const double cos_near = std::cos(10 * deg);

std::vector<MeanElements> made_before(std::vector<MeanElements> elements, const Utc& start) {
  double newest = -1e9;
  for (const MeanElements& e : elements)
    newest = std::max(newest, epoch_days_between(start, {e.epoch_jd1, e.epoch_jd2}));
  for (MeanElements& e : elements) e.epoch_jd1 -= std::ceil(newest);
  return elements;
}

}  // namespace

struct WatchedCrowd::Instant {
  EarthShadow shadow;
};

WatchedCrowd::WatchedCrowd(std::vector<MeanElements> elements, const Clock& clock,
                           const DiffuseSphere& sphere)
    : clock_(clock),
      sphere_(sphere),
      paths_(made_before(std::move(elements), clock.utc(SimTime{})), clock, {}) {}

OrbitEstimate WatchedCrowd::believed(std::size_t i, std::uint64_t seed) const {
  OrbitEstimate out = paths_.estimate(i);
  const Eigen::Matrix3d axes = orbit_axes(out.state);
  const Eigen::Matrix3d spread = axes.transpose() * out.covariance.topLeftCorner<3, 3>() * axes;
  const RngKey key = rng_key(seed, "crowd", 0, "element sets");
  Eigen::Vector3d off;
  for (int axis = 0; axis < 3; ++axis)
    off[axis] = std::sqrt(spread(axis, axis)) *
                normal_of(rng_word(key, std::uint32_t(i), std::uint32_t(axis)));
  const Vec<Gcrs> r = out.state.position_m, v = out.state.velocity_m_per_s;
  const Vec<Gcrs> place = gcrs_of(axes * off);
  out.state.position_m += place;
  out.state.velocity_m_per_s += cross(cross(r, v) / dot(r, r), place);
  return out;
}

void WatchedCrowd::add_others(const WatchedExposure& e, const Instant& now,
                              const WatchedOrbit::Draw& draw, PassExposure& out) const {
  const OrbitWatcher& watcher = *e.watcher;
  const RngKey key = rng_key(draw.seed, watcher.name, e.number, "crowd");
  const Vec<Gcrs> up = unit(e.sensor_m);
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (!paths_.known(i)) continue;
    const Vec<Gcrs> line = paths_.position_m(i) - e.sensor_m;
    const double range_m = norm(line);
    if (dot(line, e.direction) < cos_near * range_m) continue;
    out.others.push_back(believed(i, draw.seed));
    const double phase_rad = angle_rad(e.sun_m - paths_.position_m(i), -line);
    const std::uint32_t n = std::uint32_t(i);
    if (dot(line, up) < range_m * std::sin(watcher.min_elevation_rad) ||
        now.shadow.sunlit_fraction(paths_.position_m(i)) < 0.5 ||
        diffuse_sphere_magnitude(sphere_, {.range_m = range_m, .phase_rad = phase_rad}) >
            watcher.limiting_magnitude ||
        uniform_of(rng_word(key, n, 0)) > draw.detection_probability)
      continue;
    SeenMotion seen = drawn_motion(watcher, e.time, e.sensor_m, e.sensor_m_per_s,
                                   {paths_.position_m(i), paths_.velocity_m_per_s(i)}, key, n);
    seen.observation.detection_id =
        watcher.name + "/" + std::to_string(e.number) + "/" + std::to_string(i + 1);
    out.sources.push_back(std::move(seen));
  }
}

std::vector<std::vector<PassExposure>> WatchedCrowd::passes(
    const std::vector<WatchedExposure>& exposures, const WatchedOrbit::Draw& draw) {
  std::vector<std::vector<PassExposure>> out;
  std::optional<Instant> now;
  for (const WatchedExposure& e : exposures) {
    if (!now || paths_.time() != e.time) {
      paths_.move(e.time);
      now.emplace(Instant{{e.sun_m, oblate_earth(earth_orientation(clock_, e.time))}});
    }
    if (out.empty() || (e.time - out.back().back().time).seconds() > crowd_gap_s)
      out.emplace_back();
    PassExposure& added = out.back().emplace_back();
    added.time = e.time;
    added.sensor_m = e.sensor_m;
    added.sensor_m_per_s = e.sensor_m_per_s;
    added.half_angle_rad = e.watcher->half_angle_rad;
    if (e.seen) added.sources.push_back(*e.seen);
    add_others(e, *now, draw, added);
  }
  return out;
}

}  // namespace dmise
