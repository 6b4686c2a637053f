#include "core/detection/describe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/units.h"
#include "core/detection/known/aberration.h"
#include "core/detection/known/atmosphere.h"
#include "core/detection/known/mid_exposure.h"
#include "core/detection/known/refraction_parallax.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr double bend_error = 0.3;       // relative, of a bend that is not fitted
constexpr double slope_error = 0.3;      // relative, of a change of brightness
constexpr double most_off_middle = 0.5;  // mid exposure is corrected up to here [half lengths]

struct Tangent {
  Vec<Gcrs> east, north;
};

Tangent tangent_at(const Vec<Gcrs>& direction) {
  Vec<Gcrs> east = cross(Vec<Gcrs>{0, 0, 1}, direction);
  east = norm(east) > 1e-12 ? unit(east) : Vec<Gcrs>{0, 1, 0};
  return {east, cross(direction, east)};
}

/// Derivatives of an image position by the seven parameters of a trail.
using PlaceBy = std::array<std::array<double, 2>, 7>;

/// var x, cov xy, var y of a position that depends on the fitted parameters.
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

/// Covariance as var(ra cos dec), cov, var(dec) [rad^2] around a pixel, including the error of the
/// WCS.
std::array<double, 3> on_the_sky(const std::array<double, 3>& covariance_px2, const Wcs& wcs,
                                 PixelPosition at) {
  const Tangent tangent = tangent_at(wcs_direction(wcs, at));
  const auto change = [&](PixelPosition half) {
    return wcs_direction(wcs, at + half) - wcs_direction(wcs, at - half);
  };
  const Vec<Gcrs> by_x = change({0.5, 0}), by_y = change({0, 0.5});
  const double ex = dot(by_x, tangent.east), ey = dot(by_y, tangent.east);
  const double nx = dot(by_x, tangent.north), ny = dot(by_y, tangent.north);
  const double wcs_px2 = wcs.rms_px * wcs.rms_px / 2;
  const double xx = covariance_px2[0] + wcs_px2, xy = covariance_px2[1],
               yy = covariance_px2[2] + wcs_px2;
  return {ex * ex * xx + 2 * ex * ey * xy + ey * ey * yy,
          ex * nx * xx + (ex * ny + ey * nx) * xy + ey * ny * yy,
          nx * nx * xx + 2 * nx * ny * xy + ny * ny * yy};
}

/// Centroid of light: a brightness slope moves it off the line's middle.
MeasuredPlace centroid_of(const Source& source) {
  const Trail& t = source.trail();
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double shift = t.slope * t.length_px / 6;
  const PlaceBy by = {{{1, 0},
                       {0, 1},
                       {0, 0},
                       {t.slope / 6 * c, t.slope / 6 * s},
                       {-shift * s, shift * c},
                       {t.length_px / 6 * c, t.length_px / 6 * s},
                       {0, 0}}};
  return {{t.x_px + shift * c, t.y_px + shift * s}, covariance_of(source, by)};
}

/// A point of the curved line: -1 and 1 are its ends, 0 its middle.
MeasuredPlace line_point(const Source& source, double r) {
  const Trail& t = source.trail();
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double along = r * t.length_px / 2, bend = 1.0 / 3 - r * r, across = bend * t.sagitta_px;
  const PlaceBy by = {{{1, 0},
                       {0, 1},
                       {0, 0},
                       {r / 2 * c, r / 2 * s},
                       {-along * s - across * c, along * c - across * s},
                       {0, 0},
                       {-bend * s, bend * c}}};
  return {{t.x_px + along * c - across * s, t.y_px + along * s + across * c},
          covariance_of(source, by)};
}

/// Adds a variance along one direction of a plane.
void add_along(std::array<double, 3>& covariance, double x, double y, double variance) {
  covariance[0] += variance * x * x;
  covariance[1] += variance * x * y;
  covariance[2] += variance * y * y;
}

/// An end of the line, with errors for neglected terms of a trail's curvature (third power) and
/// brightness (second): sizes measured on low orbits.
MeasuredPlace line_end(const Source& source, const FrameHeader& header, double side,
                       double arc_rad) {
  MeasuredPlace end = line_point(source, side);
  const Trail& t = source.trail();
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  const double along_px = 0.05 * header.psf_fwhm_px * arc_rad * arc_rad;
  const double across_px = 0.035 * t.sagitta_px * arc_rad;
  add_along(end.covariance_px2, c, s, along_px * along_px);
  add_along(end.covariance_px2, -s, c, across_px * across_px);
  return end;
}

double arc_of(const Source& source, const FrameHeader& header) {
  return angle_rad(wcs_direction(header.wcs, line_point(source, -1).place),
                   wcs_direction(header.wcs, line_point(source, 1).place));
}

/// How much later than the first a row is exposed, in whole microseconds, as times are written.
SimTime row_delay(const FrameHeader& header, double y_px) {
  if (!header.detector || !(header.detector->row_time_us > 0.0)) return {};
  return {1000 * std::llround(header.detector->row_time_us * std::max(y_px, 0.0))};
}

/// A source as whoever found it measured it, in pixels and electrons.
struct SourceLine {
  bool streak = false, saturated = false, at_edge = false;
  double light_e = 0.0, snr = 0.0;
  MeasuredPlace centroid;
  std::array<MeasuredPlace, 2> ends;
  // The line through the light, in which a slope of brightness or a bend may have been neglected.
  PixelPosition middle;
  double length_px = 0.0, angle_rad = 0.0;
  bool knows_slope = false, knows_bend = false;
  std::function<MeasuredPlace(double)> point;  // place on the line: -1 and 1 are its ends
};

/// Whether a streak's end is the first of both.
bool is_end1(const PixelPosition& a, const PixelPosition& b) {
  return a.x_px < b.x_px || (a.x_px == b.x_px && a.y_px < b.y_px);
}

void describe_ends(const SourceLine& source, const FrameHeader& header, Detection& d) {
  auto [first, last] = source.ends;
  if (is_end1(last.place, first.place)) std::swap(first, last);
  d.end1_x_px = first.place.x_px;
  d.end1_y_px = first.place.y_px;
  d.end2_x_px = last.place.x_px;
  d.end2_y_px = last.place.y_px;
  d.end1_covariance_rad2 = on_the_sky(first.covariance_px2, header.wcs, first.place);
  d.end2_covariance_rad2 = on_the_sky(last.covariance_px2, header.wcs, last.place);
  d.length_px = source.streak ? source.length_px : 0.0;
  const Vec<Gcrs> end1 = wcs_direction(header.wcs, first.place);
  const Vec<Gcrs> end2 = wcs_direction(header.wcs, last.place);
  std::tie(d.end1_ra_rad, d.end1_dec_rad) = std::tuple_cat(to_spherical(end1));
  std::tie(d.end2_ra_rad, d.end2_dec_rad) = std::tuple_cat(to_spherical(end2));
  const SimTime delay1 = row_delay(header, d.end1_y_px), delay2 = row_delay(header, d.end2_y_px);
  d.end1_time = (source.streak ? header.start : header.middle) + delay1;
  d.end2_time = (source.streak ? header.end : header.middle) + delay2;
  const double moving_s = std::max(header.exposure_s + (delay2 - delay1).seconds(), 1e-9);
  d.rate_rad_per_s = source.streak ? angle_rad(end1, end2) / moving_s : 0.0;
}

/// Change of light from the middle to the second end, relative, by distance and air.
double slope_of(const FrameHeader& header, PixelPosition end1, PixelPosition end2,
                double end1_range_over_end2) {
  const double magnitudes = extinction_mag(header, end1) - extinction_mag(header, end2);
  const double ratio = end1_range_over_end2 * end1_range_over_end2 * std::pow(10, 0.4 * magnitudes);
  return (ratio - 1) / (ratio + 1);
}

/// The object's position on the line at mid exposure, and its error along the line.
struct MidPoint {
  MeasuredPlace point;
  Vec<Gcrs> track;  // from end to end
  double sigma_rad = 0.0;
};

MidPoint mid_point(const SourceLine& source, const FrameHeader& header) {
  if (!source.streak) return {source.point(0.0), {}, 0.0};
  const PixelPosition first = source.point(-1).place, last = source.point(1).place;
  const Vec<Gcrs> end1 = wcs_direction(header.wcs, first), end2 = wcs_direction(header.wcs, last);
  const MidExposure mid = mid_exposure(header, end1, end2, source.at_edge);
  const auto pixel = wcs_pixel(header.wcs, mid.direction);
  if (!pixel || !(source.length_px > 0)) return {source.point(0.0), end2 - end1, mid.sigma_rad};
  const double c = std::cos(source.angle_rad), s = std::sin(source.angle_rad);
  const PixelPosition way = *pixel - source.middle;
  double along_px = way.x_px * c + way.y_px * s, uneven_px = 0.0;
  if (!source.knows_slope) {
    // Fitted as even: its centroid is towards the brighter end, where the object is nearer and
    // higher.
    const double slope = slope_of(header, first, last, mid.end1_range_over_end2);
    uneven_px = slope * source.length_px / 6;
    along_px -= uneven_px;
  }
  const double r = std::clamp(2 * along_px / source.length_px, -1.0, 1.0);
  MeasuredPlace point = source.point(r);
  add_along(point.covariance_px2, c, s, std::pow(slope_error * uneven_px, 2));
  if (!source.knows_bend && std::abs(r) < most_off_middle) {
    // Fitted as straight: it bends as the orbit through its ends does in this projection.
    const double sagitta_px = (way.y_px * c - way.x_px * s) / (1 - r * r);
    const double across_px = sagitta_px * (1.0 / 3 - r * r);
    point.place = point.place + PixelPosition{-s, c} * across_px;
    add_along(point.covariance_px2, -s, c, std::pow(bend_error * across_px, 2));
  }
  return {point, end2 - end1, mid.sigma_rad};
}

void describe_direction(const SourceLine& source, const FrameHeader& header, Detection& d) {
  const MidPoint mid = mid_point(source, header);
  const SimTime delay = row_delay(header, mid.point.place.y_px);
  d.time = header.middle + delay;
  d.sensor_position_m = header.sensor_position_m + header.sensor_velocity_m_per_s * delay.seconds();
  const Vec<Gcrs> here = wcs_direction(header.wcs, mid.point.place);
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

  d.covariance_rad2 = on_the_sky(mid.point.covariance_px2, header.wcs, mid.point.place);
  const Tangent tangent = tangent_at(here);
  // A user who knows the range removes it at `corrected`, where east differs near a pole.
  const Tangent there = tangent_at(unit(corrected));
  add_along(d.covariance_rad2, dot(parallax.upwards, there.east),
            dot(parallax.upwards, there.north), parallax.sigma_rad * parallax.sigma_rad);
  const double e = dot(mid.track, tangent.east), n = dot(mid.track, tangent.north);
  const double chord = std::hypot(e, n);
  if (!(chord > 0)) return;
  const double angle = std::atan2(e, n);
  d.position_angle_rad = angle < 0 ? angle + 2 * pi : angle;
  add_along(d.covariance_rad2, e / chord, n / chord, mid.sigma_rad * mid.sigma_rad);
}

/// Returns the light without the noise that a fit adds to it by the choice of the shape: on average
/// 1 / (2 SNR^2) of it for each parameter of the shape (Refregier et al. 2012, MNRAS 425, 1951).
double light_without_noise_e(const Source& source) {
  constexpr unsigned shape = trail_x | trail_y | trail_length | trail_angle | trail_sagitta;
  const double snr = std::max(source.snr(), 5.0);
  return source.trail().flux_e * (1.0 - std::popcount(source.free & shape) / (2.0 * snr * snr));
}

Detection describe(const SourceLine& source, const FrameHeader& header) {
  Detection d;
  d.sensor = header.sensor;
  d.frame = header.frame;
  d.kind = source.streak ? DetectionKind::streak : DetectionKind::point;
  d.epoch = ExposureEpoch::middle;
  d.sensor_velocity_m_per_s = header.sensor_velocity_m_per_s;
  d.aberration_removed = true;
  d.band = header.band.name;
  d.signal_e = source.light_e;
  d.snr = source.snr;
  d.magnitude = header.zero_point_mag - 2.5 * std::log10(d.signal_e / header.exposure_s) -
                extinction_mag(header, source.middle);
  d.magnitude_system = header.magnitudes.system;
  d.magnitude_sigma = 2.5 / std::log(10.0) / d.snr;
  d.saturated = source.saturated;
  d.at_edge = source.at_edge;
  d.x_px = source.centroid.place.x_px;
  d.y_px = source.centroid.place.y_px;
  d.covariance_px2 = source.centroid.covariance_px2;
  describe_ends(source, header, d);
  describe_direction(source, header, d);
  return d;
}

/// Variance of a streak's length; 0 where it was not fitted.
double length_variance_px2(const Source& source) {
  if (!(source.free & trail_length)) return 0.0;
  const int at = std::popcount(source.free & (unsigned(trail_length) - 1));
  return std::max(source.fit.cov(at, at), 0.0);
}

/// Error of a point of a line, of which those of centroid and ends are known.
std::array<double, 3> covariance_between(const SourceLine& source, double r) {
  const auto& end = source.ends[r < 0 ? 0 : 1].covariance_px2;
  std::array<double, 3> covariance{};
  for (std::size_t i = 0; i < 3; ++i)
    covariance[i] = (1 - r * r) * source.centroid.covariance_px2[i] + r * r * end[i];
  return covariance;
}

}  // namespace

Detection describe(const Source& source, const FrameHeader& header) {
  const Trail& t = source.trail();
  const double arc_rad = arc_of(source, header);
  return describe(SourceLine{.streak = source.streak,
                             .saturated = source.saturated,
                             .at_edge = source.at_edge,
                             .light_e = light_without_noise_e(source),
                             .snr = source.snr(),
                             .centroid = centroid_of(source),
                             .ends = {line_end(source, header, -1, arc_rad),
                                      line_end(source, header, 1, arc_rad)},
                             .middle = {t.x_px, t.y_px},
                             .length_px = t.length_px,
                             .angle_rad = t.angle_rad,
                             .knows_slope = bool(source.free & trail_slope),
                             .knows_bend = bool(source.free & trail_sagitta),
                             .point = [&](double r) { return line_point(source, r); }},
                  header);
}

Detection describe(const MeasuredSource& source, const FrameHeader& header, bool saturated,
                   bool at_edge) {
  SourceLine measured{.saturated = saturated,
                      .at_edge = at_edge,
                      .light_e = source.light_e,
                      .snr = source.snr,
                      .centroid = source.centroid,
                      .ends = {source.centroid, source.centroid},
                      .middle = source.centroid.place,
                      .knows_slope = true,
                      .point = [&](double) { return source.centroid; }};
  if (source.ends) {
    auto [first, last] = *source.ends;
    if (is_end1(last.place, first.place)) std::swap(first, last);
    const PixelPosition way = last.place - first.place;
    const double length_px = std::hypot(way.x_px, way.y_px);
    const double c = way.x_px / length_px, s = way.y_px / length_px;
    // The line is parallel to the chord, through the centroid: a bend moves that across.
    const PixelPosition half = way * 0.5, off = source.centroid.place - (first.place + half);
    const double across_px = off.y_px * c - off.x_px * s;
    measured.streak = true;
    measured.ends = {first, last};
    measured.middle = first.place + half + PixelPosition{-s, c} * across_px;
    measured.length_px = length_px;
    measured.angle_rad = std::atan2(way.y_px, way.x_px);
    measured.point = [&measured, half](double r) {
      return MeasuredPlace{measured.middle + half * r, covariance_between(measured, r)};
    };
  }
  return describe(measured, header);
}

void describe_light(const Source& source, MeasuredCurve measured, const FrameHeader& header,
                    Detection& d) {
  const double length_px = source.trail().length_px;
  if (is_end1(line_point(source, 1).place, line_point(source, -1).place))
    measured.curve = reversed(measured.curve, length_px);
  LightCurve& curve = d.light_curve.emplace(std::move(measured.curve));
  for (const double along_px : curve.along_px) {
    const double share = along_px / length_px;
    const double y_px = d.end1_y_px + share * (d.end2_y_px - d.end1_y_px);
    curve.time_s.push_back(share * header.exposure_s + row_delay(header, y_px).seconds());
  }
  const double moving_s = std::max((d.end2_time - d.end1_time).seconds(), 0.0);
  if (curve.min_period_px) curve.min_period_s = *curve.min_period_px / length_px * moving_s;
  if (!curve.period) return;
  LightPeriod& period = *curve.period;
  // The exposure's ends are anywhere in the dark beyond those of the light.
  const double first_px = measured.dark_first_px, last_px = measured.dark_last_px;
  const double whole_px = length_px + 0.5 * (first_px + last_px);
  // The fit of even light misses either end of uneven light by about half a FWHM, a bin.
  const double variance_px2 = length_variance_px2(source) + curve.bin_px * curve.bin_px / 2 +
                              (first_px * first_px + last_px * last_px) / 12;
  period.period_s = period.period_px / whole_px * moving_s;
  period.period_sigma_s = period.period_s * std::hypot(period.period_sigma_px / period.period_px,
                                                       std::sqrt(variance_px2) / whole_px);
}

void add_detection(Detection d, const FrameHeader& header, std::vector<Detection>& detections) {
  d.index = std::uint32_t(detections.size());
  d.excluded = header.excluded.any();
  d.id = d.sensor + "/" + std::to_string(d.frame) + "/" + std::to_string(d.index);
  detections.push_back(std::move(d));
}

}  // namespace dmise
