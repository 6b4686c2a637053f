#include "core/fusion/mount.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

double azimuth_of(const Vec<Enu>& d) { return std::atan2(d.x, d.y); }
double elevation_of(const Vec<Enu>& d) { return std::atan2(d.z, std::hypot(d.x, d.y)); }

struct Axis {
  double deg_per_s, deg_per_s2;
};

Axis azimuth_axis(const CueSettings& cue) {
  return cue.azimuth_deg_per_s > 0 ? Axis{cue.azimuth_deg_per_s, cue.azimuth_deg_per_s2}
                                   : Axis{cue.slew_deg_per_s, cue.slew_deg_per_s2};
}

bool in_range(const CueSettings& cue, double azimuth_rad) {
  return azimuth_rad >= cue.azimuth_range_deg[0] * deg &&
         azimuth_rad <= cue.azimuth_range_deg[1] * deg;
}

}  // namespace

MountPosition mount_position(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * deg, e = elevation_deg * deg;
  return {{std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)}, a};
}

double turn_s(double angle_rad, double v, double a) {
  const double angle = angle_rad / deg;
  if (!(a > 0)) return angle / v;
  return angle < v * v / a ? 2 * std::sqrt(angle / a) : angle / v + v / a;
}

std::vector<Slew> slews_to(const CueSettings& cue, const MountPosition& from,
                           const Vec<Enu>& direction) {
  if (cue.mount == MountKind::great_circle) {
    const double angle = angle_rad(from.direction, direction);
    return {{angle, turn_s(angle, cue.slew_deg_per_s, cue.slew_deg_per_s2), {direction}}};
  }
  const double up = std::fabs(elevation_of(direction) - elevation_of(from.direction));
  const double up_s = turn_s(up, cue.slew_deg_per_s, cue.slew_deg_per_s2);
  const Axis axis = azimuth_axis(cue);
  std::vector<Slew> ways;
  const double azimuth = azimuth_of(direction), turn = 2 * pi;
  const double first = std::ceil((cue.azimuth_range_deg[0] * deg - azimuth) / turn);
  for (double k = first; in_range(cue, azimuth + k * turn); ++k) {
    const double to = azimuth + k * turn, around = std::fabs(to - from.azimuth_rad);
    ways.push_back({std::max(up, around),
                    std::max(up_s, turn_s(around, axis.deg_per_s, axis.deg_per_s2)),
                    {direction, to}});
  }
  std::ranges::stable_sort(ways, {}, &Slew::seconds);
  return ways;
}

std::optional<MountPosition> followed(const CueSettings& cue, const MountPosition& from,
                                      const Vec<Enu>& direction, double seconds) {
  if (cue.mount == MountKind::great_circle) return MountPosition{direction};
  const double around = std::remainder(azimuth_of(direction) - from.azimuth_rad, 2 * pi);
  const double up = std::fabs(elevation_of(direction) - elevation_of(from.direction));
  const MountPosition to{direction, from.azimuth_rad + around};
  if (std::fabs(around) > azimuth_axis(cue).deg_per_s * deg * seconds ||
      up > cue.slew_deg_per_s * deg * seconds || !in_range(cue, to.azimuth_rad))
    return std::nullopt;
  return to;
}

}  // namespace dmise
