#include "core/detection/known/mid_exposure.h"

#include <cmath>
#include <optional>

namespace dmise {
namespace {

constexpr double earth_gm_m3_per_s2 = 3.986004415e14;
constexpr double min_height_m = 100e3, largest_radius_m = 1e9;

/// Lines of sight at start and end of the exposure, from the sensor's positions.
struct Sight {
  Vec<Gcrs> sensor_m, direction;

  /// Position along a line at a distance from the Earth's centre greater than the sensor's.
  Vec<Gcrs> at_radius_m(double radius_m) const {
    const double along = dot(sensor_m, direction);
    const double square = along * along - dot(sensor_m, sensor_m) + radius_m * radius_m;
    return sensor_m + direction * (std::sqrt(square) - along);
  }
};

struct Places {
  Vec<Gcrs> start_m, end_m;
  double excess_rad;  // angle between them less the orbit's
};

Places places_at(const Sight& start, const Sight& end, double radius_m, double exposure_s,
                 double radial_share) {
  const double turned_rad = std::sqrt(earth_gm_m3_per_s2 / std::pow(radius_m, 3)) * exposure_s;
  const double rise = radial_share * turned_rad / 2;
  Places p{start.at_radius_m(radius_m * (1 - rise)), end.at_radius_m(radius_m * (1 + rise)), 0.0};
  p.excess_rad = angle_rad(p.start_m, p.end_m) - turned_rad;
  return p;
}

/// On the orbit through both lines of sight: direction at mid exposure, and the ratio of distances
/// at start and end.
struct OnOrbit {
  Vec<Gcrs> direction;
  double start_range_over_end;
};

/// Empty if there is no such orbit.
std::optional<OnOrbit> on_an_orbit(const FrameHeader& header, const Sight& start, const Sight& end,
                                   double radial_share) {
  const auto at = [&](double radius_m) {
    return places_at(start, end, radius_m, header.exposure_s, radial_share);
  };
  // The angle grows with the radius, the orbit's decreases.
  double low_m = norm(header.sensor_position_m) + min_height_m, high_m = largest_radius_m;
  if (!(at(low_m).excess_rad < 0 && at(high_m).excess_rad > 0)) return std::nullopt;
  for (int step = 0; step < 60; ++step) {
    const double middle_m = std::sqrt(low_m * high_m);
    (at(middle_m).excess_rad < 0 ? low_m : high_m) = middle_m;
  }
  const Places p = at(low_m);
  return OnOrbit{unit(unit(p.start_m + p.end_m) * low_m - header.sensor_position_m),
                 norm(p.start_m - start.sensor_m) / norm(p.end_m - end.sensor_m)};
}

}  // namespace

MidExposure mid_exposure(const FrameHeader& header, const Vec<Gcrs>& end1, const Vec<Gcrs>& end2,
                         bool at_edge) {
  const double arc_rad = angle_rad(end1, end2);
  const MidExposure even{unit(end1 + end2), at_edge ? arc_rad / 2 : arc_rad * arc_rad / 4};
  if (at_edge || !header.site || !(arc_rad > 0)) return even;
  const auto camera = [&](std::size_t k) {
    return rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[k]);
  };
  const auto start_from_middle = camera(0).inverse() * camera(1);
  const auto end_from_middle = camera(2).inverse() * camera(1);
  const Vec<Gcrs> way_m = header.sensor_velocity_m_per_s * (header.exposure_s / 2);
  const auto mid = [&](const Vec<Gcrs>& from, const Vec<Gcrs>& to, double radial_share) {
    return on_an_orbit(header, {header.sensor_position_m - way_m, start_from_middle * from},
                       {header.sensor_position_m + way_m, end_from_middle * to}, radial_share);
  };
  const auto onwards = mid(end1, end2, 0.0), back = mid(end2, end1, 0.0);
  const auto rising = mid(end1, end2, radial_speed_share);
  if (!onwards || !back || !rising) return even;
  const Vec<Gcrs>&a = onwards->direction, &b = back->direction, &c = rising->direction;
  return {unit(a + b), std::hypot(norm(a - b) / 2, norm(c - a)),
          std::sqrt(onwards->start_range_over_end / back->start_range_over_end)};
}

}  // namespace dmise
