#include "core/detection/streaks/streaks_beside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/line_profile.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/source/star_hypothesis.h"

namespace dmise {
namespace {

constexpr double reach_sigmas = 6.0;          // across, to which a second streak is searched for
constexpr double apart_sigmas = 2.3;          // least distance of two
constexpr double step_px = 0.5;               // between values of the profile across
constexpr double min_gain = 40.0;             // gain in chi2 by the second streak
constexpr double min_gain_over_width = 10.0;  // gain in chi2 against a wide body
constexpr double min_share = 0.1;             // amplitude of the fainter over that of both
constexpr double min_overlap = 0.5;           // overlap over the shorter's length
constexpr double max_turn_rad = 0.1;
constexpr double beside_bent_from_px = 100.0;

/// Light across a line, per pixel of the frame.
struct Profile {
  double first_px;  // offset of the first value
  std::vector<double> light, variance;
};

/// The profile by pixels `from_px` to `to_px` along the line. Bins without one have no variance.
Profile profile_of(const std::vector<FitPixel>& pixels, const Line& line, double from_px,
                   double to_px, double reach_px) {
  const int half = int(std::ceil(reach_px / step_px));
  const auto size = std::size_t(2 * half + 1);
  Profile out{-half * step_px, std::vector<double>(size, 0.0), std::vector<double>(size, 0.0)};
  std::vector<int> count(size, 0);
  for (const FitPixel& p : pixels) {
    const double dx = p.x - line.x, dy = p.y - line.y;
    const double along = dx * line.ux + dy * line.uy, r = along / line.half_length_px;
    if (along < from_px || along > to_px) continue;
    const double off = dy * line.ux - dx * line.uy - line.sagitta_px * (1.0 / 3 - r * r);
    const auto bin = std::lround(off / step_px) + half;
    if (bin < 0 || bin >= long(size)) continue;
    out.light[std::size_t(bin)] += p.signal_e;
    out.variance[std::size_t(bin)] += p.variance_e2 + std::max(p.signal_e, 0.0f);
    ++count[std::size_t(bin)];
  }
  for (std::size_t k = 0; k < size; ++k) {
    if (count[k] == 0) continue;
    out.light[k] /= count[k];
    out.variance[k] /= double(count[k]) * count[k];
  }
  return out;
}

/// Two lines across a profile, and by how much chi2 is better than by one.
struct TwoOffsets {
  double one_px = 0.0, other_px = 0.0, gain = 0.0, share = 0.0;
};

TwoOffsets two_offsets(const Profile& profile, double sigma_px) {
  const std::size_t size = profile.light.size();
  const auto shape = [&](std::size_t line, std::size_t bin) {
    const double n = (double(bin) - double(line)) * step_px / sigma_px;
    return std::exp(-0.5 * n * n);
  };
  std::vector<double> right(size, 0.0);
  std::vector<std::vector<double>> product(size, std::vector<double>(size, 0.0));
  for (std::size_t k = 0; k < size; ++k) {
    if (!(profile.variance[k] > 0)) continue;
    const double weight = 1 / profile.variance[k];
    for (std::size_t a = 0; a < size; ++a) {
      const double ga = weight * shape(a, k);
      right[a] += ga * profile.light[k];
      for (std::size_t b = 0; b <= a; ++b) product[a][b] += ga * shape(b, k);
    }
  }
  double one = 0.0;
  for (std::size_t a = 0; a < size; ++a)
    if (product[a][a] > 0 && right[a] > 0) one = std::max(one, right[a] * right[a] / product[a][a]);
  TwoOffsets best;
  for (std::size_t a = 0; a < size; ++a)
    for (std::size_t b = 0; b + std::size_t(apart_sigmas * sigma_px / step_px) <= a; ++b) {
      const double aa = product[a][a], bb = product[b][b], ab = product[a][b];
      const double determinant = aa * bb - ab * ab;
      if (!(determinant > 1e-3 * aa * bb)) continue;
      const double fa = (bb * right[a] - ab * right[b]) / determinant;
      const double fb = (aa * right[b] - ab * right[a]) / determinant;
      if (!(fa > 0 && fb > 0)) continue;
      const double gain = fa * right[a] + fb * right[b] - one;
      if (gain > best.gain)
        best = {profile.first_px + double(a) * step_px, profile.first_px + double(b) * step_px,
                gain, std::min(fa, fb) / (fa + fb)};
    }
  return best;
}

/// By how much chi2 of a profile is better than by one line with a body that is wider than the PSF.
double gain_of_width(const Profile& profile, double sigma_px) {
  double one = 0.0, wide = 0.0;
  const double reach_px = -profile.first_px, narrow = 1 / (std::sqrt(2.0) * sigma_px);
  for (double width_px = 0.1; width_px < reach_px; width_px += step_px)
    for (double middle_px = -reach_px; middle_px < reach_px; middle_px += step_px / 2) {
      double right = 0.0, product = 0.0;
      for (std::size_t k = 0; k < profile.light.size(); ++k) {
        if (!(profile.variance[k] > 0)) continue;
        const double off = profile.first_px + double(k) * step_px - middle_px;
        const double g =
            std::erf((off + width_px / 2) * narrow) - std::erf((off - width_px / 2) * narrow);
        right += g * profile.light[k] / profile.variance[k];
        product += g * g / profile.variance[k];
      }
      if (!(product > 0 && right > 0)) continue;
      double& best = width_px < step_px ? one : wide;
      best = std::max(best, right * right / product);
    }
  return wide - one;
}

/// The line through two offsets at a quarter and three quarters of a trail.
Trail beside(const Trail& t, double first_px, double second_px, double flux_e) {
  Trail out = t;
  const double middle_px = 0.5 * (first_px + second_px);
  out.x_px -= middle_px * std::sin(t.angle_rad);
  out.y_px += middle_px * std::cos(t.angle_rad);
  out.angle_rad += std::atan2(second_px - first_px, t.length_px / 2);
  out.flux_e = flux_e;
  out.slope = 0.0;
  return out;
}

/// Whether two trails are alongside each other, apart and of nearly one direction.
bool are_beside(const Trail& a, const Trail& b, double sigma_px) {
  if (std::abs(std::remainder(a.angle_rad - b.angle_rad, pi)) > max_turn_rad) return false;
  const double c = std::cos(a.angle_rad), s = std::sin(a.angle_rad);
  const double along = (b.x_px - a.x_px) * c + (b.y_px - a.y_px) * s;
  const double across = (b.y_px - a.y_px) * c - (b.x_px - a.x_px) * s;
  const double overlap = std::min(a.length_px / 2, along + b.length_px / 2) -
                         std::max(-a.length_px / 2, along - b.length_px / 2);
  return std::abs(across) > apart_sigmas * sigma_px &&
         overlap > min_overlap * std::min(a.length_px, b.length_px);
}

}  // namespace

std::vector<Source> streaks_beside(const Scene& scene, const Trail& one) {
  const PixelPosition at{one.x_px, one.y_px};
  const double sigma_px = scene.psf.sigma_at(at), reach_px = reach_sigmas * sigma_px;
  const Trail star = scene.star_trail(one.x_px, one.y_px);
  if (one.length_px < 8 * sigma_px || may_be_row_of_stars(scene, one, detection_limits::chain_px))
    return {};
  auto pixels = pixels_near(scene, one, reach_px + 2.5 * sigma_px);
  if (pixels.size() < 50) return {};
  const Line line = line_of(one);
  const double half = one.length_px / 2;
  const Profile profile = profile_of(pixels, line, -half, half, reach_px);
  const TwoOffsets whole = two_offsets(profile, sigma_px);
  if (whole.gain < min_gain || whole.share < min_share ||
      whole.gain < gain_of_width(profile, sigma_px) + min_gain_over_width)
    return {};
  // Half by half, as the two may not be parallel; near where the whole has them.
  const auto first = two_offsets(profile_of(pixels, line, -half, 0, reach_px), sigma_px);
  const auto second = two_offsets(profile_of(pixels, line, 0, half, reach_px), sigma_px);
  const auto near = [&](double px, double of) { return std::abs(px - of) < 2.0 ? px : of; };
  const double flux_e = one.flux_e / 2;
  std::vector<Trail> two{
      beside(one, near(first.one_px, whole.one_px), near(second.one_px, whole.one_px), flux_e),
      beside(one, near(first.other_px, whole.other_px), near(second.other_px, whole.other_px),
             flux_e)};
  FitSettings fit_settings;
  fit_settings.psf = scene.psf.at(at);
  fit_settings.model_error = detection_limits::model_error;
  fit_settings.background_sigma_e = background_sigma_e(pixels.front());
  fit_settings.max_steps = 30;
  const unsigned free =
      one.length_px > beside_bent_from_px ? trail_line | trail_sagitta : trail_line;
  TrailFit fit;
  for (int round = 0; round < 3; ++round) {
    fit = fit_trails(pixels, two, {free, free}, fit_settings);
    two = fit.trails;
    for (const Trail& t : two)
      if (!plausible(scene, t) || t.length_px < 6 * sigma_px) return {};
    if (round < 2) pixels = without_outliers(pixels, two, fit.background_e, 0.15, fit_settings.psf);
    if (pixels.size() < 50) return {};
  }
  if (!are_beside(two[0], two[1], sigma_px) || fit.reduced_chi2() > 2.0) return {};
  const double as_one =
      fit_trails(pixels, {one}, {unsigned(trail_bent_line)}, fit_settings).deviance;
  if (as_one - fit.deviance < min_gain) return {};
  // The final covariance is that of the noise alone.
  fit_settings.model_error = 0.0;
  fit = fit_trails(pixels, two, {free, free}, fit_settings);
  std::vector<Source> out;
  for (std::size_t k = 0; k < 2; ++k) {
    Source source = part_of(fit, k, free);
    source.streak = true;
    if (!plausible(scene, source.trail()) || !(source.fit.cov(2, 2) > 0)) return {};
    hold_ends_at_edge(scene, source);
    set_flags(scene, source.trail(), source);
    if (source.snr() < detection_limits::min_snr ||
        moves_like_star(scene, source, star, detection_limits::min_difference_px + 1))
      return {};
    out.push_back(std::move(source));
  }
  return out;
}

}  // namespace dmise
