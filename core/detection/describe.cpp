#include "core/detection/describe.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/units.h"
#include "core/detection/aberration.h"
#include "core/detection/atmosphere.h"
#include "core/detection/refraction_parallax.h"
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

/// Derivatives of a place in the image by the seven parameters of a trail.
using PlaceBy = std::array<std::array<double, 2>, 7>;

/// var x, cov xy, var y of a place that moves with the fitted parameters.
std::array<double, 3> covariance_of(const Source& source, const PlaceBy& by) {
  std::vector<std::array<double, 2>> j;
  for (unsigned bit = 0; bit < by.size(); ++bit)
    if (source.free >> bit & 1u) j.push_back(by[bit]);
  std::array<double, 3> out{};
  for (std::size_t a = 0; a < j.size(); ++a)
    for (std::size_t b = 0; b < j.size(); ++b) {
      const double v = source.fit.cov(int(a), int(b));
      out[0] += j[a][0] * v * j[b][0];
      out[1] += j[a][0] * v * j[b][1];
      out[2] += j[a][1] * v * j[b][1];
    }
  return out;
}

/// The same in var(ra cos dec), cov, var(dec) [rad^2] around a pixel.
std::array<double, 3> on_the_sky(const std::array<double, 3>& covariance_px2, const Wcs& wcs,
                                 PixelPosition at) {
  const Tangent tangent = tangent_at(wcs_direction(wcs, at));
  const auto change = [&](PixelPosition half) {
    return wcs_direction(wcs, at + half) - wcs_direction(wcs, at - half);
  };
  const Vec<Gcrs> by_x = change({0.5, 0}), by_y = change({0, 0.5});
  const double ex = dot(by_x, tangent.east), ey = dot(by_y, tangent.east);
  const double nx = dot(by_x, tangent.north), ny = dot(by_y, tangent.north);
  const auto [xx, xy, yy] = covariance_px2;
  return {ex * ex * xx + 2 * ex * ey * xy + ey * ey * yy,
          ex * nx * xx + (ex * ny + ey * nx) * xy + ey * ny * yy,
          nx * nx * xx + 2 * nx * ny * xy + ny * ny * yy};
}

/// Centroid of light: the slope moves it off the line's middle.
void describe_centroid(const Source& source, Detection& d) {
  const Trail& t = source.trail();
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double shift = t.slope * t.length_px / 6;
  d.x_px = t.x_px + shift * c;
  d.y_px = t.y_px + shift * s;
  const PlaceBy by = {{{1, 0},
                       {0, 1},
                       {0, 0},
                       {t.slope / 6 * c, t.slope / 6 * s},
                       {-shift * s, shift * c},
                       {t.length_px / 6 * c, t.length_px / 6 * s},
                       {0, 0}}};
  d.covariance_px2 = covariance_of(source, by);
}

/// One end of the line, at +length/2 (`side` 1) or -length/2 (-1).
struct End {
  PixelPosition place;
  std::array<double, 3> covariance_px2;
};

End end_of(const Source& source, double side) {
  const Trail& t = source.trail();
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double along = side * t.length_px / 2, across = -2.0 / 3 * t.sagitta_px;
  const PlaceBy by = {{{1, 0},
                       {0, 1},
                       {0, 0},
                       {side / 2 * c, side / 2 * s},
                       {-along * s - across * c, along * c - across * s},
                       {0, 0},
                       {2.0 / 3 * s, -2.0 / 3 * c}}};
  return {{t.x_px + along * c - across * s, t.y_px + along * s + across * c},
          covariance_of(source, by)};
}

void describe_ends(const Source& source, const FrameHeader& header, Detection& d) {
  End first = end_of(source, -1), last = end_of(source, 1);
  const PixelPosition a = first.place, b = last.place;
  if (b.x_px < a.x_px || (b.x_px == a.x_px && b.y_px < a.y_px)) std::swap(first, last);
  d.end1_x_px = first.place.x_px;
  d.end1_y_px = first.place.y_px;
  d.end2_x_px = last.place.x_px;
  d.end2_y_px = last.place.y_px;
  d.end1_covariance_rad2 = on_the_sky(first.covariance_px2, header.wcs, first.place);
  d.end2_covariance_rad2 = on_the_sky(last.covariance_px2, header.wcs, last.place);
  d.length_px = source.streak ? source.trail().length_px : 0.0;
  const Vec<Gcrs> end1 = wcs_direction(header.wcs, first.place);
  const Vec<Gcrs> end2 = wcs_direction(header.wcs, last.place);
  std::tie(d.end1_ra_rad, d.end1_dec_rad) = std::tuple_cat(to_spherical(end1));
  std::tie(d.end2_ra_rad, d.end2_dec_rad) = std::tuple_cat(to_spherical(end2));
  d.end1_time = source.streak ? header.start : header.middle;
  d.end2_time = source.streak ? header.end : header.middle;
  d.rate_rad_per_s = source.streak ? angle_rad(end1, end2) / header.exposure_s : 0.0;
}

/// Adds a variance along one direction of the tangent plane.
void add_along(std::array<double, 3>& covariance, double east, double north, double variance) {
  covariance[0] += variance * east * east;
  covariance[1] += variance * east * north;
  covariance[2] += variance * north * north;
}

void describe_direction(const FrameHeader& header, Detection& d) {
  const Vec<Gcrs> here = wcs_direction(header.wcs, {d.x_px, d.y_px});
  std::tie(d.ra_rad, d.dec_rad) = std::tuple_cat(to_spherical(here));
  const RefractionParallax parallax = refraction_parallax(header, here);
  d.refraction_removed = !refraction_of(header);
  d.refraction_offset_m = parallax.offset_m;
  d.refraction_parallax_rad = parallax.mean_rad;
  d.refraction_parallax_sigma_rad = parallax.sigma_rad;
  const Vec<Gcrs> corrected = without_annual_aberration(here, header.earth_velocity_m_per_s,
                                                        header.sensor_velocity_m_per_s) +
                              parallax.upwards * parallax.mean_rad;
  std::tie(d.corrected_ra_rad, d.corrected_dec_rad) = std::tuple_cat(to_spherical(corrected));

  d.covariance_rad2 = on_the_sky(d.covariance_px2, header.wcs, {d.x_px, d.y_px});
  const Tangent tangent = tangent_at(here);
  add_along(d.covariance_rad2, dot(parallax.upwards, tangent.east),
            dot(parallax.upwards, tangent.north), parallax.sigma_rad * parallax.sigma_rad);
  if (d.kind == DetectionKind::point) return;
  const Vec<Gcrs> track = wcs_direction(header.wcs, {d.end2_x_px, d.end2_y_px}) -
                          wcs_direction(header.wcs, {d.end1_x_px, d.end1_y_px});
  const double e = dot(track, tangent.east), n = dot(track, tangent.north);
  const double chord = std::hypot(e, n), arc = d.rate_rad_per_s * header.exposure_s;
  if (!(chord > 0)) return;
  add_along(d.covariance_rad2, e / chord, n / chord, std::pow(arc * arc / 12, 2));
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
