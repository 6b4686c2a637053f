#include "core/detection/streaks/line_between.h"

#include <algorithm>

#include "core/detection/source/line_profile.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/source/template_snr.h"

namespace dmise {
namespace {

constexpr double min_step_px = 0.5, step_share = 0.125;
constexpr double slopes_inverse_variance = 3.0;  // for slopes spread evenly from -1 to 1
constexpr double edge_sigmas = 4.0;              // light fades over so much of the PSF at an end
constexpr double across_sigmas = 2.5;            // within which pixels are used
constexpr double outlier = 4.0;                  // standard deviations
constexpr double end_sigmas = 2.0;               // an end may miss an edge by so much of the PSF
constexpr double gap_sigmas = 5.0;  // in a gap of so much of the PSF nothing is known of a trail

/// A pixel in the fit of a line's light per px: its light and weight at a place along the line, by
/// the share of that light in it and its variance.
struct Sample {
  double along_px, light, weight;
};

/// Usable pixels on a trail's line and beyond its ends, without outliers, by rising place.
std::vector<Sample> samples_along(const Scene& scene, const Trail& t, double sigma_px,
                                  double beyond_px) {
  const Line line = line_of(t);
  const Extent extent = in_frame(scene, line, extent_of(line, t.length_px / 2 + beyond_px));
  const StarlitSky sky = starlit_sky(scene, t);
  const double noise_e = std::sqrt(double(scene.pixel_around(t.x_px, t.y_px).variance_e2));
  const double sky_e = sky.level * noise_e, scatter2 = sky.scatter * sky.scatter;
  const double level = t.flux_e / std::max(t.length_px, 1.0);
  const int reach = int(std::ceil(across_sigmas * sigma_px * line.slice_px()));
  std::vector<Sample> out;
  for (int k = extent.from; k <= extent.to; ++k) {
    const Point centre = line.at(k);
    const int nearest = int(std::lround(line.by_columns() ? centre.y : centre.x));
    for (int m = nearest - reach; m <= nearest + reach; ++m) {
      const int x = line.by_columns() ? k : m, y = line.by_columns() ? m : k;
      if (!scene.contains(x, y) || !scene.is_usable(x, y)) continue;
      const double dx = x - t.x_px, dy = y - t.y_px;
      const double along = dx * line.ux + dy * line.uy, r = along / line.half_length_px;
      const double across = dy * line.ux - dx * line.uy - line.sagitta_px * (1.0 / 3 - r * r);
      const double profile = normal_density(across / sigma_px) / sigma_px;
      const FitPixel pixel = scene.pixel(x, y);
      const double own_e = std::abs(r) < 1 ? level * profile : 0.0;
      const double variance = pixel.variance_e2 + own_e, signal = pixel.signal_e - sky_e;
      if (signal > level * profile + outlier * std::sqrt(variance)) continue;
      const double weight = profile / (variance * scatter2);
      out.push_back({along, signal * weight, profile * weight});
    }
  }
  std::ranges::stable_sort(out, {}, &Sample::along_px);
  return out;
}

std::vector<double> places_between(double first_px, double last_px, double half_length_px) {
  std::vector<double> out;
  for (double at = first_px; at <= last_px;) {
    out.push_back(at);
    const double distance_px = std::abs(std::abs(at) - half_length_px);
    at += std::max(min_step_px, step_share * distance_px);
  }
  return out;
}

/// How far a trail is measured to one side of its middle, if it ends at the edge of pixels without
/// a value; else infinite. As at the frame's edge, light is that of the measured part.
double measured_to_px(const Scene& scene, const Trail& t, double side, double sigma_px) {
  const double end_px = t.length_px / 2;
  if (!scene.unusable) return HUGE_VAL;
  double edge_px = end_px;
  while (has_values_at(scene, t, side * edge_px)) {
    edge_px += min_step_px;
    if (edge_px > end_px + end_sigmas * sigma_px) return HUGE_VAL;
  }
  for (double px = edge_px; px < edge_px + gap_sigmas * sigma_px; px += min_step_px)
    if (has_values_at(scene, t, side * px)) return HUGE_VAL;
  return edge_px;
}

void add(Beyond& to, const Sample& s, double share) {
  double light = share * s.light, weight = share * s.weight;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k < 2) to.light[k] += light;
    to.weight[k] += weight;
    to.square[k] += share * weight;
    light *= s.along_px;
    weight *= s.along_px;
  }
}

}  // namespace

std::vector<Beyond> ends_along(const Scene& scene, const Trail& trail, double beyond_px) {
  const double sigma_px = scene.psf.sigma_at({trail.x_px, trail.y_px});
  const auto samples = samples_along(scene, trail, sigma_px, beyond_px);
  if (samples.size() < 3) return {};
  const auto places =
      places_between(samples.front().along_px, samples.back().along_px, trail.length_px / 2);
  const double before_px = measured_to_px(scene, trail, -1, sigma_px);
  const double behind_px = measured_to_px(scene, trail, 1, sigma_px);
  std::vector<Beyond> whole(samples.size() + 1);  // all light from a sample on
  for (std::size_t k = samples.size(); k-- > 0;) {
    whole[k] = whole[k + 1];
    add(whole[k], samples[k], 1.0);
  }
  std::vector<Beyond> out;
  std::vector<double> shares;  // light beyond an end, for samples near it
  std::size_t begin = 0, end = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double at = places[i];
    if (at < -before_px || at > behind_px) continue;
    while (begin < samples.size() && samples[begin].along_px < at - edge_sigmas * sigma_px) ++begin;
    while (end < samples.size() && samples[end].along_px <= at + edge_sigmas * sigma_px) ++end;
    Beyond b = whole[end];
    b.along_px = at;
    b.width_px = (places[std::min(i + 1, places.size() - 1)] - places[i > 0 ? i - 1 : 0]) / 2;
    shares.clear();
    for (std::size_t k = begin; k < end; ++k)
      shares.push_back((samples[k].along_px - at) / sigma_px);
    normal_below_each(shares);
    for (std::size_t k = begin; k < end; ++k) add(b, samples[k], shares[k - begin]);
    out.push_back(b);
  }
  return out;
}

LineBetween::LineBetween(const Beyond& first, const Beyond& last, bool sloped)
    : middle_px_((first.along_px + last.along_px) / 2), length_px_(last.along_px - first.along_px) {
  // For the line's shape h: sums of light h, and of weight h^2, times k^0, k^1, k^2. Where light is
  // beyond the last end, the share beyond the first is 1.
  std::array<double, 3> square;
  for (std::size_t k = 0; k < 3; ++k)
    square[k] = first.square[k] - 2 * last.weight[k] + last.square[k];
  const double light = first.light[0] - last.light[0], by_half = 2 / length_px_;
  if (!(light > 0) || !(square[0] > 0)) return;
  const double even = light / square[0];
  if (!sloped) {
    level_ = even;
    level2_ = 1 / square[0];
    gain_ = light * even;
    volume_ = square[0] * gain_ * gain_;
    return;
  }
  // Level, and slope times level with the slope's prior.
  const double turned = by_half * (first.light[1] - last.light[1] - middle_px_ * light);
  const double cross = by_half * (square[1] - middle_px_ * square[0]);
  const double spread =
      square[2] - 2 * middle_px_ * square[1] + middle_px_ * middle_px_ * square[0];
  const double tilt = by_half * by_half * spread + slopes_inverse_variance / (even * even);
  const double determinant = square[0] * tilt - cross * cross;
  if (!(determinant > 0)) return;
  const double inverse = 1 / determinant;
  level_ = (tilt * light - cross * turned) * inverse;
  if (!(level_ > 0)) return;
  const double tilted = (square[0] * turned - cross * light) * inverse;
  slope_ = tilted / level_;
  level2_ = tilt * inverse;
  both_ = -cross * inverse;
  tilt2_ = square[0] * inverse;
  const double flat = even * light * even;
  gain_ = level_ * light + tilted * turned;
  volume_ = determinant * flat * flat;
}

void LineBetween::add_to(EndErrors& errors, const Trail& trail, double turn_rad,
                         double likely) const {
  const std::array<double, end_parameters> off{
      middle_px_ * std::cos(turn_rad), flux_e() - trail.flux_e, length_px_ - trail.length_px,
      slope_ - trail.slope, middle_px_ * std::sin(turn_rad)};
  for (std::size_t i = 0; i < end_parameters; ++i)
    for (std::size_t j = 0; j < end_parameters; ++j) errors[i][j] += likely * off[i] * off[j];
  const double both = length_px_ * (both_ - slope_ * level2_) / level_;
  const double slope2 =
      (tilt2_ - 2 * slope_ * both_ + slope_ * slope_ * level2_) / (level_ * level_);
  errors[end_flux][end_flux] += likely * length_px_ * length_px_ * level2_;
  errors[end_flux][end_slope] += likely * both;
  errors[end_slope][end_flux] += likely * both;
  errors[end_slope][end_slope] += likely * slope2;
}

}  // namespace dmise
