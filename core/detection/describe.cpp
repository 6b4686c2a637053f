#include "core/detection/describe.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/units.h"
#include "core/detection/aberration.h"
#include "core/detection/atmosphere.h"
#include "core/detection/wcs.h"

namespace dmise {
namespace {

struct Tangent {
  Vec<Gcrs> east, north;
};

Tangent tangent_at(const Vec<Gcrs>& direction) {
  Vec<Gcrs> east = cross(Vec<Gcrs>{0, 0, 1}, direction);
  east = norm(east) > 1e-12 ? unit(east) : Vec<Gcrs>{0, 1, 0};
  return {east, cross(direction, east)};
}

/// Centroid of light and its covariance: the slope moves it off the line's middle.
void describe_centroid(const Source& source, Detection& d) {
  const Trail& t = source.trail();
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double shift = t.slope * t.length_px / 6;
  d.x_px = t.x_px + shift * c;
  d.y_px = t.y_px + shift * s;
  std::vector<double> jx, jy;  // derivatives by the fit's parameters, in its order
  const double by[7][2] = {{1, 0},
                           {0, 1},
                           {0, 0},
                           {t.slope / 6 * c, t.slope / 6 * s},
                           {-shift * s, shift * c},
                           {t.length_px / 6 * c, t.length_px / 6 * s},
                           {0, 0}};
  for (unsigned bit = 0; bit < 7; ++bit)
    if (source.free >> bit & 1u) {
      jx.push_back(by[bit][0]);
      jy.push_back(by[bit][1]);
    }
  d.covariance_px2 = {0, 0, 0};
  for (std::size_t i = 0; i < jx.size(); ++i)
    for (std::size_t j = 0; j < jx.size(); ++j) {
      const double v = source.fit.cov(int(i), int(j));
      d.covariance_px2[0] += jx[i] * v * jx[j];
      d.covariance_px2[1] += jx[i] * v * jy[j];
      d.covariance_px2[2] += jy[i] * v * jy[j];
    }
}

void describe_ends(const Source& source, const FrameHeader& header, Detection& d) {
  const Trail& t = source.trail();
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double half = t.length_px / 2, bend = -2.0 / 3 * t.sagitta_px;
  double ends[2][2] = {{t.x_px - half * c - bend * s, t.y_px - half * s + bend * c},
                       {t.x_px + half * c - bend * s, t.y_px + half * s + bend * c}};
  const bool swapped =
      ends[1][0] < ends[0][0] || (ends[1][0] == ends[0][0] && ends[1][1] < ends[0][1]);
  if (swapped) std::swap(ends[0], ends[1]);
  d.end1_x_px = ends[0][0];
  d.end1_y_px = ends[0][1];
  d.end2_x_px = ends[1][0];
  d.end2_y_px = ends[1][1];
  d.length_px = source.streak ? t.length_px : 0.0;
  const Vec<Gcrs> end1 = wcs_direction(header.wcs, {d.end1_x_px, d.end1_y_px});
  const Vec<Gcrs> end2 = wcs_direction(header.wcs, {d.end2_x_px, d.end2_y_px});
  std::tie(d.end1_ra_rad, d.end1_dec_rad) = std::tuple_cat(to_spherical(end1));
  std::tie(d.end2_ra_rad, d.end2_dec_rad) = std::tuple_cat(to_spherical(end2));
  d.end1_time = source.streak ? header.start : header.middle;
  d.end2_time = source.streak ? header.end : header.middle;
  d.rate_rad_per_s = source.streak ? angle_rad(end1, end2) / header.exposure_s : 0.0;
}

void describe_direction(const FrameHeader& header, Detection& d) {
  const Vec<Gcrs> here = wcs_direction(header.wcs, {d.x_px, d.y_px});
  std::tie(d.ra_rad, d.dec_rad) = std::tuple_cat(to_spherical(here));
  const Vec<Gcrs> corrected = without_annual_aberration(here, header.earth_velocity_m_per_s,
                                                        header.sensor_velocity_m_per_s);
  std::tie(d.corrected_ra_rad, d.corrected_dec_rad) = std::tuple_cat(to_spherical(corrected));

  const Tangent tangent = tangent_at(here);
  const auto change = [&](double dx, double dy) {
    return wcs_direction(header.wcs, {d.x_px + dx, d.y_px + dy}) -
           wcs_direction(header.wcs, {d.x_px - dx, d.y_px - dy});
  };
  const Vec<Gcrs> by_x = change(0.5, 0), by_y = change(0, 0.5);
  const double ex = dot(by_x, tangent.east), ey = dot(by_y, tangent.east);
  const double nx = dot(by_x, tangent.north), ny = dot(by_y, tangent.north);
  const auto [xx, xy, yy] = d.covariance_px2;
  d.covariance_rad2 = {ex * ex * xx + 2 * ex * ey * xy + ey * ey * yy,
                       ex * nx * xx + (ex * ny + ey * nx) * xy + ey * ny * yy,
                       nx * nx * xx + 2 * nx * ny * xy + ny * ny * yy};
  if (d.kind == DetectionKind::point) return;
  const Vec<Gcrs> track = wcs_direction(header.wcs, {d.end2_x_px, d.end2_y_px}) -
                          wcs_direction(header.wcs, {d.end1_x_px, d.end1_y_px});
  const double e = dot(track, tangent.east), n = dot(track, tangent.north);
  const double chord = std::hypot(e, n), arc = d.rate_rad_per_s * header.exposure_s;
  if (!(chord > 0)) return;
  const double variance = std::pow(arc * arc / 12, 2);
  d.covariance_rad2[0] += variance * e * e / (chord * chord);
  d.covariance_rad2[1] += variance * e * n / (chord * chord);
  d.covariance_rad2[2] += variance * n * n / (chord * chord);
}

}  // namespace

Detection describe(const Source& source, const FrameHeader& header) {
  Detection d;
  d.sensor = header.sensor;
  d.frame = header.frame;
  d.kind = source.streak ? DetectionKind::streak : DetectionKind::point;
  d.epoch = ExposureEpoch::middle;
  d.time = header.middle;
  d.sensor_position_m = header.sensor_position_m;
  d.sensor_velocity_m_per_s = header.sensor_velocity_m_per_s;
  d.aberration_removed = true;
  d.band = header.band.name;
  d.signal_e = source.trail().flux_e;
  d.snr = source.snr();
  d.magnitude = header.zero_point_mag - 2.5 * std::log10(d.signal_e / header.exposure_s) -
                extinction_mag(header, {source.trail().x_px, source.trail().y_px});
  d.magnitude_sigma = 2.5 / std::log(10.0) / d.snr;
  d.saturated = source.saturated;
  d.at_edge = source.at_edge;
  describe_centroid(source, d);
  describe_ends(source, header, d);
  describe_direction(header, d);
  return d;
}

}  // namespace dmise
