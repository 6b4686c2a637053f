#include "core/sequences/describe_track.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/units.h"
#include "core/detection/describe.h"
#include "core/detection/make_report.h"
#include "core/detection/pixels/components.h"
#include "core/frames/vec.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

/// Directions at the place of a motion, by pixels: east and north [rad/px], of x and of y.
using Jacobian = std::array<double, 4>;

struct SkyAxes {
  Vec<Gcrs> here, east, north;
};

SkyAxes axes_at(const Vec<Gcrs>& here) {
  const Vec<Gcrs> pole{0, 0, 1};
  const Vec<Gcrs> across = cross(pole, here);
  const Vec<Gcrs> east = norm(across) > 0 ? unit(across) : Vec<Gcrs>{0, 1, 0};
  return {here, east, cross(here, east)};
}

Jacobian sky_by_pixels(const Wcs& wcs, PixelPosition at, const SkyAxes& axes) {
  const auto change = [&](PixelPosition half) {
    return wcs_direction(wcs, at + half) - wcs_direction(wcs, at - half);
  };
  const Vec<Gcrs> x = change({0.5, 0}), y = change({0, 0.5});
  return {dot(x, axes.east), dot(y, axes.east), dot(x, axes.north), dot(y, axes.north)};
}

/// Covariance of place and rate on the sky, lower triangle by rows.
std::array<double, 10> on_the_sky(const MotionCovariance& c, const Jacobian& j) {
  std::array<double, 10> out{};
  std::size_t at = 0;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b <= a; ++b, ++at)
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t l = 0; l < 2; ++l)
          out[at] += j[(a % 2) * 2 + k] * j[(b % 2) * 2 + l] * c[a / 2 * 2 + k][b / 2 * 2 + l];
  return out;
}

/// Covariance of the place, in a frame.
std::array<double, 3> in_frame(const MotionCovariance& c, const std::array<double, 4>& a) {
  const double xx = c[0][0], xy = c[0][1], yy = c[1][1];
  return {a[0] * a[0] * xx + 2 * a[0] * a[1] * xy + a[1] * a[1] * yy,
          a[0] * a[2] * xx + (a[0] * a[3] + a[1] * a[2]) * xy + a[1] * a[3] * yy,
          a[2] * a[2] * xx + 2 * a[2] * a[3] * xy + a[3] * a[3] * yy};
}

/// Light of a point over its amplitude through the filter, with the trail of its exposure.
double light_of_amplitude(const PsfField& psf, PixelPosition at, double sigma_px, double trail_px) {
  const Psf shape = psf.at(at);
  double overlap = 0.0;
  for (std::size_t k = 0; k < shape.count; ++k) {
    const double v = shape.parts[k].sigma_px * shape.parts[k].sigma_px + sigma_px * sigma_px;
    const double u = trail_px / std::sqrt(8 * v);
    const double trailed = u > 1e-6 ? std::sqrt(pi) / 2 * std::erf(u) / u : 1.0;
    overlap += shape.parts[k].weight * trailed / (2 * pi * v);
  }
  return std::sqrt(kernel_square_sum(sigma_px)) / overlap;
}

bool is_clipped(const SequenceFrame& frame, PixelPosition at) {
  const long x = std::lround(at.x_px), y = std::lround(at.y_px);
  return x >= 0 && y >= 0 && x < frame.counts.columns && y < frame.counts.rows &&
         frame.counts.at(int(x), int(y)) >= lowest_clipped_dn(frame.header);
}

bool is_at_edge(const SequenceFrame& frame, PixelPosition at, double width_px) {
  return std::min({at.x_px, at.y_px, frame.counts.columns - 1 - at.x_px,
                   frame.counts.rows - 1 - at.y_px}) < width_px;
}

SequencePosition position_of(const TrackPoint& point, const MovingTrack& track,
                             const TrackScene& scene, const SequenceFrame& frame) {
  const FilteredSequence& sequence = scene.sequence;
  const double time_s = sequence.frames[point.frame].time_s;
  const PixelPosition at = point.measured.value_or(point.place);
  SequencePosition out{.file = frame.name,
                       .frame = frame.header.frame,
                       .time_utc = frame.header.middle_utc,
                       .after_s = time_s,
                       .x_px = at.x_px,
                       .y_px = at.y_px,
                       .covariance_px2 = point.covariance_px2,
                       .snr = point.snr,
                       .measured = point.measured.has_value(),
                       .used = point.used};
  if (!point.measured)
    out.covariance_px2 = in_frame(
        covariance_at(track, time_s),
        scene.registration.around(sequence.reference, point.frame, track.motion.at(time_s), 8.0)
            .matrix);
  std::tie(out.ra_rad, out.dec_rad) =
      std::tuple_cat(to_spherical(wcs_direction(frame.header.wcs, at)));
  return out;
}

/// The used point nearest in time to the reference frame.
const TrackPoint& home_of(const MovingTrack& track, const FilteredSequence& sequence) {
  const auto away = [&](const TrackPoint& p) {
    return std::abs(sequence.frames[p.frame].time_s) + (p.used ? 0.0 : 1e9);
  };
  return *std::ranges::min_element(track.points, {}, away);
}

void set_rate(const MovingTrack& track, const Wcs& wcs, double time_s, SequenceTrack& out) {
  const PixelPosition at = track.motion.at(time_s);
  const SkyAxes axes = axes_at(wcs_direction(wcs, at));
  const Jacobian j = sky_by_pixels(wcs, at, axes);
  const PixelPosition rate = track.motion.rate + track.motion.acceleration * time_s;
  out.rate_px_per_s = rate;
  out.rate_ra_rad_per_s = j[0] * rate.x_px + j[1] * rate.y_px;
  out.rate_dec_rad_per_s = j[2] * rate.x_px + j[3] * rate.y_px;
  out.covariance = on_the_sky(covariance_at(track, time_s), j);
  Detection& d = out.detection;
  d.rate_rad_per_s = std::hypot(out.rate_ra_rad_per_s, out.rate_dec_rad_per_s);
  const double angle = std::atan2(out.rate_ra_rad_per_s, out.rate_dec_rad_per_s);
  d.position_angle_rad = angle < 0 ? angle + 2 * pi : angle;
  d.direction_known = true;
}

}  // namespace

SequenceTrack describe_track(const MovingTrack& track, const TrackScene& scene,
                             const std::vector<SequenceFrame>& frames) {
  const FilteredSequence& sequence = scene.sequence;
  const TrackPoint& home = home_of(track, sequence);
  const SequenceFrame& frame = frames[home.frame];
  const double time_s = sequence.frames[home.frame].time_s;
  const PixelPosition trail = (track.motion.rate - scene.range.middle) * sequence.exposure_s;
  const double light_e = track.amplitude_e * scene.registration.transmission(home.frame) *
                         light_of_amplitude(sequence.frames[home.frame].psf, home.place,
                                            sequence.sigma_px, std::hypot(trail.x_px, trail.y_px));
  const LinearMap map =
      scene.registration.around(sequence.reference, home.frame, track.motion.at(time_s), 8.0);
  const MeasuredSource source{
      .centroid = {home.place, in_frame(covariance_at(track, time_s), map.matrix)},
      .ends = std::nullopt,
      .light_e = light_e,
      .snr = track.snr};
  SequenceTrack out;
  out.header = frame.header;
  out.detection = describe(source, frame.header, is_clipped(frame, home.place),
                           is_at_edge(frame, home.place, fwhm_per_sigma * sequence.sigma_px));
  set_rate(track, frames[sequence.reference].header.wcs, time_s, out);
  for (const TrackPoint& point : track.points) {
    out.positions.push_back(position_of(point, track, scene, frames[point.frame]));
    out.positions.back().after_s -= time_s;
  }
  return out;
}

void number_track(SequenceTrack& track, std::uint32_t index) {
  Detection& d = track.detection;
  d.index = index;
  d.excluded = track.header.excluded.any();
  d.id = d.sensor + "/" + std::to_string(d.frame) + "/" + std::to_string(index);
}

}  // namespace dmise
