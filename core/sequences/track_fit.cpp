#include "core/sequences/track_fit.h"

#include <algorithm>
#include <cmath>

#include "core/base/algebra/small_matrix.h"
#include "core/base/algebra/symmetric2.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr int max_steps = 20, first_steps = 5;  // before frames that disagree are left out
constexpr double max_displaced_chi2 = 14.0;     // 2 degrees of freedom: 1 in 1000 by chance
constexpr double max_step_px = 0.7, converged_px = 1e-3;
constexpr double max_way_widths = 3.0;     // from the start of a fit to its end, FWHM
constexpr double place_error_px = 0.02;    // in each frame, by the shape of pixels
constexpr double shown_snr = 6.0;          // from which on a frame's own place is measured
constexpr double linear_px = 8.0;          // over which a map between frames is measured
constexpr double neglected_orders = 25.0;  // growth of the covariance, over the square of the SNR
constexpr double min_seen_snr = 0.5;       // that a frame of a track must add to be of use

/// How a point's SNR falls off around its place, and how noise slopes there.
struct Response {
  Symmetric2 curvature{};  // for a point of SNR 1 [1/px2]
  double slope_variance = 0.0;
};

/// One frame as a track sees it.
struct FrameView {
  std::size_t frame;
  double time_s, noise_e;
  LinearMap map;             // from the reference frame
  Symmetric2 map_error_px2;  // by the stars of the frame and by those of the reference frame
  Response response;
  bool used = true;
};

/// The curvature along a trail is that of a wider point.
Symmetric2 curvature_of(const PsfField& psf, PixelPosition at, double sigma_px,
                        PixelPosition trail) {
  const Psf shape = psf.at(at);
  const double length2 = trail.x_px * trail.x_px + trail.y_px * trail.y_px;
  double sum = 0.0, across = 0.0, along = 0.0;
  for (std::size_t k = 0; k < shape.count; ++k) {
    const double v = shape.parts[k].sigma_px * shape.parts[k].sigma_px + sigma_px * sigma_px;
    const double light = shape.parts[k].weight / v;
    sum += light;
    across += light / v;
    along += light / (v + length2 / 12);
  }
  across /= sum;
  along /= sum;
  if (!(length2 > 0)) return {across, 0.0, across};
  const double xx = trail.x_px * trail.x_px / length2, xy = trail.x_px * trail.y_px / length2,
               yy = trail.y_px * trail.y_px / length2, less = along - across;
  return {across + less * xx, less * xy, across + less * yy};
}

std::vector<FrameView> views_of(const TrackScene& scene, const SkyMotion& start) {
  std::vector<FrameView> views;
  const FilteredSequence& sequence = scene.sequence;
  const PixelPosition trail = (start.rate - scene.range.middle) * sequence.exposure_s;
  const double s2 = sequence.sigma_px * sequence.sigma_px;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    const FilteredLight& frame = sequence.frames[i];
    const LinearMap map =
        scene.registration.around(sequence.reference, i, start.at(frame.time_s), linear_px);
    const PixelPosition at = map.shift;
    const SnrAt here = snr_at(scene.light[i], at);
    if (!(here.weight > 0)) continue;
    const double noise_e =
        double(frame.background.sigma_dn(int(std::lround(at.x_px)), int(std::lround(at.y_px)))) *
        frame.gain_e_per_dn;
    views.push_back(
        {.frame = i,
         .time_s = frame.time_s,
         .noise_e = noise_e,
         .map = map,
         .map_error_px2 = scene.registration.error_px2(i, start.at(frame.time_s)),
         .response = {curvature_of(frame.psf, at, sequence.sigma_px, trail), 1 / (2 * s2)}});
  }
  return views;
}

/// Light of all frames that are used, by their weights.
struct AddedLight {
  double light = 0.0, weight = 0.0;

  double amplitude_e() const { return weight > 0 ? light / weight : 0.0; }
  double snr() const { return light / std::sqrt(weight); }
};

AddedLight added_light(const std::vector<FrameView>& views, const std::vector<SnrAt>& seen) {
  AddedLight sum;
  for (std::size_t k = 0; k < views.size(); ++k) {
    if (!views[k].used) continue;
    sum.light += seen[k].weight * seen[k].snr;
    sum.weight += seen[k].weight * seen[k].weight;
  }
  return sum;
}

/// Leaves out frames in which something brighter than a faint track is at its place.
void leave_out_brighter(std::vector<FrameView>& views, const std::vector<SnrAt>& seen) {
  std::vector<double> amplitudes;
  for (const SnrAt& at : seen)
    if (at.weight > 0) amplitudes.push_back(at.snr / at.weight);
  if (amplitudes.empty()) return;
  const double usual = median_of(amplitudes);
  for (std::size_t k = 0; k < views.size(); ++k) {
    const double expected = usual * seen[k].weight;
    views[k].used = seen[k].weight > 0 &&
                    (expected > max_snr_of_frame || seen[k].snr < expected + max_snr_of_frame);
  }
}

std::vector<SnrAt> seen_by(const std::vector<MovingLight>& light,
                           const std::vector<FrameView>& views, const SkyMotion& motion) {
  std::vector<SnrAt> seen;
  for (const FrameView& view : views)
    seen.push_back(snr_at(light[view.frame], view.map(motion.at(view.time_s))));
  return seen;
}

/// a' m a: turns a symmetric matrix from the axes of a frame to those of the reference frame.
Symmetric2 turned(const Symmetric2& m, const std::array<double, 4>& a) {
  const double xx = m[0] * a[0] + m[1] * a[2], xy = m[0] * a[1] + m[1] * a[3],
               yx = m[1] * a[0] + m[2] * a[2], yy = m[1] * a[1] + m[2] * a[3];
  return {a[0] * xx + a[2] * yx, a[0] * xy + a[2] * yy, a[1] * xy + a[3] * yy};
}

constexpr std::size_t parameters = 6;  // x, y, x', y', x'', y''

/// Derivatives of a place by itself, its rate and its acceleration.
std::array<double, 3> powers_of(double time_s) { return {1.0, time_s, time_s * time_s / 2}; }

/// Adds weight * m of a place at a time to a matrix of the motion's parameters.
void add_at(SmallMatrix& to, const Symmetric2& m, double time_s, double weight) {
  const std::array<double, 4> full{m[0], m[1], m[1], m[2]};
  const auto times = powers_of(time_s);
  for (std::size_t i = 0; i < parameters; ++i)
    for (std::size_t j = 0; j < parameters; ++j)
      to[i][j] += weight * full[(i % 2) * 2 + j % 2] * times[i / 2] * times[j / 2];
}

struct Equations {
  SmallMatrix information{}, noise{};
  SmallVector slope{};
};

/// Variance of the slope of SNR of a frame: of the sky, of the source's own photons (a Gaussian's)
/// and of the error of the frame's place.
Symmetric2 slope_noise(const FrameView& view, double snr, double sigma_px) {
  const double own = 4 * std::max(snr, 0.0) / (9 * std::sqrt(pi) * sigma_px * view.noise_e);
  const double sky = view.response.slope_variance * (1 + own);
  const Symmetric2 &c = view.response.curvature, &map = view.map_error_px2;
  const double pixels = place_error_px * place_error_px;
  const Symmetric2 off =
      turned({map[0] / 2 + pixels, map[1] / 2, map[2] / 2 + pixels}, {c[0], c[1], c[1], c[2]});
  return {sky + snr * snr * off[0], snr * snr * off[1], sky + snr * snr * off[2]};
}

/// Error of a track's place by the stars of the reference frame, which all other frames share.
Symmetric2 common_error_px2(const std::vector<FrameView>& views) {
  Symmetric2 sum{};
  double count = 0.0;
  for (const FrameView& view : views) {
    if (!view.used) continue;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += view.map_error_px2[k] / 2;
    count += 1;
  }
  for (double& v : sum) v /= count;
  return sum;
}

/// Leaves out frames that show the source beside the track by more than noise does, as on a star or
/// a cosmic ray; three frames at least stay.
void leave_out_displaced(std::vector<FrameView>& views, const std::vector<SnrAt>& seen,
                         double sigma_px) {
  auto used = std::ranges::count_if(views, [](const FrameView& view) { return view.used; });
  for (std::size_t k = 0; k < views.size() && used > long(min_sequence_frames); ++k) {
    const double slope2 = std::pow(seen[k].slope.x_px, 2) + std::pow(seen[k].slope.y_px, 2);
    const Symmetric2 noise = slope_noise(views[k], seen[k].snr, sigma_px);
    if (!views[k].used || slope2 < max_displaced_chi2 * (noise[0] + noise[2]) / 2) continue;
    views[k].used = false;
    --used;
  }
}

Equations equations_of(const std::vector<FrameView>& views, const std::vector<SnrAt>& seen,
                       double amplitude_e, double sigma_px) {
  Equations out;
  for (std::size_t k = 0; k < views.size(); ++k) {
    const FrameView& view = views[k];
    const SnrAt& at = seen[k];
    if (!view.used || !(at.weight > 0)) continue;
    const double w2 = at.weight * at.weight, expected = amplitude_e * at.weight;
    add_at(out.information, turned(view.response.curvature, view.map.matrix), view.time_s,
           w2 * amplitude_e);
    add_at(out.noise, turned(slope_noise(view, expected, sigma_px), view.map.matrix), view.time_s,
           w2);
    const auto& a = view.map.matrix;
    const double gx = a[0] * at.slope.x_px + a[2] * at.slope.y_px,
                 gy = a[1] * at.slope.x_px + a[3] * at.slope.y_px;
    const auto times = powers_of(view.time_s);
    for (std::size_t i = 0; i < parameters; ++i)
      out.slope[i] += at.weight * (i % 2 == 0 ? gx : gy) * times[i / 2];
  }
  return out;
}

/// Adds what is known of the acceleration before.
void add_prior(Equations& equations, PixelPosition acceleration, double sigma_px_per_s2) {
  const double information = 1 / (sigma_px_per_s2 * sigma_px_per_s2);
  for (std::size_t i = 4; i < parameters; ++i) {
    equations.information[i][i] += information;
    equations.noise[i][i] += information;
    equations.slope[i] -= information * (i == 4 ? acceleration.x_px : acceleration.y_px);
  }
}

/// Inverse of the information times the noise times the inverse.
MotionCovariance covariance_of(const SmallMatrix& factor, const SmallMatrix& noise) {
  std::array<SmallVector, parameters> inverse;
  for (std::size_t i = 0; i < parameters; ++i) inverse[i] = inverse_column(factor, i, parameters);
  MotionCovariance out{};
  for (std::size_t i = 0; i < parameters; ++i)
    for (std::size_t j = 0; j < parameters; ++j)
      for (std::size_t k = 0; k < parameters; ++k)
        for (std::size_t l = 0; l < parameters; ++l)
          out[i][j] += inverse[i][k] * noise[k][l] * inverse[j][l];
  return out;
}

/// Greatest shift of the track by a change of its motion over the frames.
double shift_px(const SkyMotion& change, const std::vector<FrameView>& views) {
  double most = 0.0;
  for (const FrameView& view : views) {
    const PixelPosition by = change.at(view.time_s);
    most = std::max(most, std::hypot(by.x_px, by.y_px));
  }
  return most;
}

SkyMotion operator+(const SkyMotion& a, const SkyMotion& b) {
  return {a.place + b.place, a.rate + b.rate, a.acceleration + b.acceleration};
}
SkyMotion operator*(const SkyMotion& a, double s) {
  return {a.place * s, a.rate * s, a.acceleration * s};
}
SkyMotion motion_of(const SmallVector& v) { return {{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}}; }

/// The place of a source in one frame alone.
void measure(const MovingLight& light, const FrameView& view, double sigma_px, TrackPoint& point) {
  if (point.snr < shown_snr) return;
  const Symmetric2 inverse = inverse_of(view.response.curvature);
  PixelPosition place = point.place;
  for (int step = 0; step < 5; ++step) {
    const SnrAt at = snr_at(light, place);
    if (!(at.snr > shown_snr / 2)) return;
    place = place + PixelPosition{inverse[0] * at.slope.x_px + inverse[1] * at.slope.y_px,
                                  inverse[1] * at.slope.x_px + inverse[2] * at.slope.y_px} *
                        (1 / at.snr);
  }
  if (std::hypot(place.x_px - point.place.x_px, place.y_px - point.place.y_px) > 1.5 * sigma_px)
    return;
  point.measured = place;
  const Symmetric2 noise = slope_noise(view, point.snr, sigma_px);
  // The inverse is symmetric: inverse * noise * inverse, over the square of the SNR.
  point.covariance_px2 = turned(noise, {inverse[0], inverse[1], inverse[1], inverse[2]});
  const double snr2 = point.snr * point.snr;
  for (double& v : point.covariance_px2) v *= (1 + neglected_orders / snr2) / snr2;
}

bool is_in(const FilteredSequence& sequence, PixelPosition p) {
  return p.x_px >= 0 && p.y_px >= 0 && p.x_px <= sequence.columns - 1 &&
         p.y_px <= sequence.rows - 1;
}

/// Describes the track in each frame that saw its place.
void set_points(const TrackScene& scene, const std::vector<FrameView>& views,
                const std::vector<SnrAt>& seen, MovingTrack& track) {
  for (std::size_t k = 0; k < views.size(); ++k) {
    const PixelPosition place = views[k].map(track.motion.at(views[k].time_s));
    if (!is_in(scene.sequence, place) || !(seen[k].weight > 0)) continue;
    TrackPoint& point = track.points.emplace_back();
    point.frame = views[k].frame;
    point.place = place;
    point.snr = seen[k].snr;
    point.expected = track.amplitude_e * seen[k].weight;
    point.used = views[k].used && point.expected > min_seen_snr;
    if (point.used) measure(scene.light[point.frame], views[k], scene.sequence.sigma_px, point);
  }
}

}  // namespace

std::size_t MovingTrack::used() const {
  return std::size_t(std::ranges::count_if(points, [](const TrackPoint& p) { return p.used; }));
}

SnrAt snr_at(const MovingLight& light, PixelPosition place) {
  const double fx = std::floor(place.x_px), fy = std::floor(place.y_px);
  if (!(fx >= 1 && fy >= 1 && fx + 2 < light.snr.columns && fy + 2 < light.snr.rows)) return {};
  const int x = int(fx), y = int(fy);
  SnrAt out;
  for (int v = y - 1; v <= y + 2; ++v)
    for (int u = x - 1; u <= x + 2; ++u)
      if (!(light.weight.at(u, v) > 0)) return {};
  out.weight = double(light.weight.at(int(std::lround(place.x_px)), int(std::lround(place.y_px))));
  const auto wx = cubic_weights(place.x_px - fx), wy = cubic_weights(place.y_px - fy),
             dx = cubic_slopes(place.x_px - fx), dy = cubic_slopes(place.y_px - fy);
  for (std::size_t v = 0; v < 4; ++v)
    for (std::size_t u = 0; u < 4; ++u) {
      const auto value = double(light.snr.at(x - 1 + int(u), y - 1 + int(v)));
      out.snr += value * double(wx[u]) * double(wy[v]);
      out.slope.x_px += value * double(dx[u]) * double(wy[v]);
      out.slope.y_px += value * double(wx[u]) * double(dy[v]);
    }
  return out;
}

std::optional<MovingTrack> fit_track(const TrackScene& scene, const SkyMotion& start) {
  std::vector<FrameView> views = views_of(scene, start);
  if (views.size() < min_sequence_frames) return std::nullopt;
  const double sigma_px = scene.sequence.sigma_px;
  const double acceleration = std::max(scene.range.acceleration_px_per_s2(start.rate), 1e-12);
  MovingTrack track{.motion = start};
  Equations equations;
  std::vector<SnrAt> seen;
  for (int step = 0; step < max_steps; ++step) {
    seen = seen_by(scene.light, views, track.motion);
    leave_out_brighter(views, seen);
    if (step >= first_steps) leave_out_displaced(views, seen, sigma_px);
    track.amplitude_e = added_light(views, seen).amplitude_e();
    if (!(track.amplitude_e > 0)) return std::nullopt;
    equations = equations_of(views, seen, track.amplitude_e, sigma_px);
    add_prior(equations, track.motion.acceleration, acceleration);
    if (!cholesky(equations.information, parameters)) return std::nullopt;
    const SkyMotion change = motion_of(solve(equations.information, equations.slope, parameters));
    const double shift = shift_px(change, views);
    if (shift < converged_px) break;
    track.motion = track.motion + change * std::min(1.0, max_step_px / shift);
    if (shift_px(track.motion + start * -1.0, views) > max_way_widths * fwhm_per_sigma * sigma_px)
      return std::nullopt;
  }
  set_points(scene, views, seen, track);
  track.snr = added_light(views, seen).snr();
  track.covariance = covariance_of(equations.information, equations.noise);
  for (auto& row : track.covariance)
    for (double& v : row) v *= 1 + neglected_orders / (track.snr * track.snr);
  const Symmetric2 common = common_error_px2(views);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) track.covariance[i][j] += common[i + j];
  if (track.used() < min_sequence_frames) return std::nullopt;
  return track;
}

double steady_snr(const MovingTrack& track, std::size_t best_left_out) {
  std::vector<std::pair<double, double>> values;  // SNR, weight
  for (const TrackPoint& point : track.points)
    values.emplace_back(std::min(point.snr, max_snr_of_frame), point.expected / track.amplitude_e);
  std::sort(values.begin(), values.end());
  double light = 0.0, weight = 0.0;
  for (std::size_t k = 0; k + best_left_out < values.size(); ++k) {
    light += values[k].first * values[k].second;
    weight += values[k].second * values[k].second;
  }
  return weight > 0 ? light / std::sqrt(weight) : 0.0;
}

MotionCovariance covariance_at(const MovingTrack& track, double time_s) {
  MotionCovariance moved{};
  const auto times = powers_of(time_s);
  // Row i of place, rate and acceleration later is the sum of those of higher order before.
  for (std::size_t i = 0; i < parameters; ++i)
    for (std::size_t j = 0; j < parameters; ++j)
      for (std::size_t k = i; k < parameters; k += 2)
        for (std::size_t l = j; l < parameters; l += 2)
          moved[i][j] += times[(k - i) / 2] * times[(l - j) / 2] * track.covariance[k][l];
  return moved;
}

}  // namespace dmise
