#include "core/camera_calibration/gaussian_stars.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/algebra/positive_matrix.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr int image_terms = 7;  // light, place, three variances, level
using ImageTerms = std::array<double, image_terms>;

/// A pixel's value and its derivatives by the terms, at three by three points of the pixel
/// (Gauss-Legendre).
std::pair<double, ImageTerms> gaussian_pixel(const ImageTerms& p, double dx, double dy) {
  constexpr std::array nodes{-0.3872983346207417, 0.0, 0.3872983346207417};
  constexpr std::array weights{5.0 / 18, 8.0 / 18, 5.0 / 18};
  const double det = p[3] * p[5] - p[4] * p[4];
  const double ixx = p[5] / det, ixy = -p[4] / det, iyy = p[3] / det;
  const double scale = 1 / (2 * pi * std::sqrt(det));
  ImageTerms by{};
  for (std::size_t j = 0; j < nodes.size(); ++j)
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double x = dx + nodes[i], y = dy + nodes[j];
      const double u = ixx * x + ixy * y, v = ixy * x + iyy * y;
      const double g = weights[i] * weights[j] * scale * std::exp(-0.5 * (x * u + y * v));
      by[0] += g;
      by[1] += p[0] * g * u;
      by[2] += p[0] * g * v;
      by[3] += 0.5 * p[0] * g * (u * u - ixx);
      by[4] += p[0] * g * (u * v - ixy);
      by[5] += 0.5 * p[0] * g * (v * v - iyy);
    }
  by[6] = 1.0;
  return {p[0] * by[0] + p[6], by};
}

using ImageMatrix = std::vector<double>;  // square in the terms, by rows

/// Normal equations of a fit over the pixels within a radius of a middle.
struct ImageEquations {
  ImageMatrix normal = ImageMatrix(image_terms * image_terms, 0.0);
  ImageMatrix by_light = normal;  // each pixel by the light that the star has there
  ImageTerms right{};
  double squares = 0.0, light_e = 0.0;
  int pixels = 0;

  ImageEquations(const StarPixels& image, const ImageTerms& p, PixelPosition middle,
                 double radius_px) {
    const int reach = int(std::ceil(radius_px));
    const int cx = int(std::lround(middle.x_px)), cy = int(std::lround(middle.y_px));
    for (int y = cy - reach; y <= cy + reach; ++y)
      for (int x = cx - reach; x <= cx + reach; ++x) {
        if (std::hypot(x - middle.x_px, y - middle.y_px) > radius_px) continue;
        const double value = image.at(x, y);
        if (!std::isfinite(value)) continue;
        const auto [model, by] = gaussian_pixel(p, x - p[1], y - p[2]);
        const double off = value - model, of_star_e = std::max(p[0] * by[0], 0.0);
        squares += off * off;
        light_e += of_star_e;
        ++pixels;
        for (std::size_t a = 0; a < image_terms; ++a) {
          right[a] += by[a] * off;
          for (std::size_t b = 0; b < image_terms; ++b) {
            normal[a * image_terms + b] += by[a] * by[b];
            by_light[a * image_terms + b] += of_star_e * by[a] * by[b];
          }
        }
      }
  }
};

bool is_image(const ImageTerms& p, PixelPosition start, double radius_px) {
  return std::isfinite(p[0] + p[6]) && p[3] > 0.01 && p[5] > 0.01 &&
         p[3] * p[5] - p[4] * p[4] > 1e-4 && std::max(p[3], p[5]) < radius_px * radius_px &&
         std::hypot(p[1] - start.x_px, p[2] - start.y_px) < 0.5 * radius_px;
}

/// Variance of a linear function of the terms: of pixels with an even variance of 1, and by the
/// photons of the star.
struct ImageNoise {
  double even = 0.0, photons = 0.0;

  ImageNoise(const ImageMatrix& covariance, const ImageMatrix& by_light, const ImageTerms& of) {
    ImageTerms row{};
    for (std::size_t a = 0; a < image_terms; ++a)
      for (std::size_t b = 0; b < image_terms; ++b)
        row[a] += covariance[a * image_terms + b] * of[b];
    for (std::size_t a = 0; a < image_terms; ++a) {
      even += of[a] * row[a];
      for (std::size_t b = 0; b < image_terms; ++b)
        photons += row[a] * by_light[a * image_terms + b] * row[b];
    }
  }
  double sigma(double even_variance) const { return std::sqrt(even_variance * even + photons); }
};

/// A star with what its deviations are made of: those of light are the greater, the nearer to its
/// middle a pixel is, where the fit is decided. Taken as even they would be too small for bright
/// stars.
struct FittedImage {
  GaussianStar star;
  ImageNoise flux, width;
  double even_variance = 0.0;  // variance of its pixels, less the star's photons
};

/// Levenberg's method.
std::optional<FittedImage> fitted_image(const StarPixels& image, const FoundStar& place,
                                        double fwhm_px, double radius_px) {
  const double start_px2 = std::pow(fwhm_px / 2.3548, 2);
  ImageTerms p{place.flux_e, place.at.x_px, place.at.y_px, start_px2, 0.0, start_px2, 0.0};
  ImageEquations now(image, p, place.at, radius_px);
  double damping = 1e-3;
  for (int step = 0; step < 40; ++step) {
    auto matrix = now.normal;
    for (std::size_t a = 0; a < image_terms; ++a) matrix[a * (image_terms + 1)] *= 1 + damping;
    if (!invert_positive(matrix, image_terms)) return std::nullopt;
    ImageTerms next = p;
    double gain = 0.0;
    for (std::size_t a = 0; a < image_terms; ++a) {
      double by = 0.0;
      for (std::size_t b = 0; b < image_terms; ++b)
        by += matrix[a * image_terms + b] * now.right[b];
      next[a] += by;
      gain += by * now.right[a];
    }
    if (is_image(next, place.at, radius_px)) {
      ImageEquations then(image, next, place.at, radius_px);
      if (then.squares <= now.squares) {
        p = next, now = std::move(then), damping *= 0.2;
        if (gain < 1e-6 * now.squares / std::max(1, now.pixels)) break;
        continue;
      }
    }
    damping = std::max(damping, 1e-6) * 10;
    if (damping > 1e6) break;
  }
  auto covariance = now.normal;
  if (now.pixels < 2 * image_terms || !invert_positive(covariance, image_terms))
    return std::nullopt;
  return FittedImage{
      .star = {.at = {p[1], p[2]}, .flux_e = p[0], .xx_px2 = p[3], .xy_px2 = p[4], .yy_px2 = p[5]},
      .flux = {covariance, now.by_light, {1.0}},
      .width = {covariance, now.by_light, {0.0, 0.0, 0.0, 0.5, 0.0, 0.5}},
      .even_variance = now.squares / (now.pixels - image_terms) - now.light_e / now.pixels};
}

bool is_within(const StarPixels& pixels, PixelPosition at, double radius_px) {
  return at.x_px >= radius_px && at.y_px >= radius_px && at.x_px < pixels.columns - 1 - radius_px &&
         at.y_px < pixels.rows - 1 - radius_px;
}

/// Light of other places within a distance, less what is known of hot pixels there.
double light_beside(const StarPixels& pixels, std::span<const FoundStar> places,
                    const FoundStar& star, double radius_px) {
  double sum = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const PixelPosition d = places[k].at - star.at;
    if (&places[k] == &star || std::abs(d.x_px) > radius_px ||
        std::hypot(d.x_px, d.y_px) > radius_px)
      continue;
    const auto i = std::size_t(std::lround(places[k].at.y_px)) * std::size_t(pixels.columns) +
                   std::size_t(std::lround(places[k].at.x_px));
    const double hot = i < pixels.hot_e.size() ? double(pixels.hot_e[i]) : 0.0;
    if (hot < 0.3 * places[k].flux_e) sum += places[k].flux_e;
  }
  return sum;
}

bool is_clipped(const StarPixels& pixels, const FoundStar& place, double radius_px) {
  const int reach = int(std::ceil(radius_px));
  const int cx = int(std::lround(place.at.x_px)), cy = int(std::lround(place.at.y_px));
  for (int y = cy - reach; y <= cy + reach; ++y)
    for (int x = cx - reach; x <= cx + reach; ++x)
      if (pixels.contains(x, y) && pixels.at(x, y) >= pixels.saturation_e) return true;
  return place.saturated;
}

/// Mean and variance of a sky's pixels without what is far above or below.
struct SkyLevel {
  double mean = 0.0, variance = 0.0, pixels = 0.0;
};

SkyLevel sky_of(std::vector<float> ring) {
  SkyLevel sky;
  std::ranges::sort(ring);
  double low = -HUGE_VAL, high = HUGE_VAL;
  for (int round = 0; round < 6; ++round) {
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (const float v : ring)
      if (double(v) >= low && double(v) <= high) sum += double(v), ++n;
    if (n < 20) return {};
    const double mean = sum / n;
    for (const float v : ring)
      if (double(v) >= low && double(v) <= high) squares += std::pow(double(v) - mean, 2);
    sky = {mean, squares / (n - 1), n};
    // The first rounds begin at the middle: light of neighbours is above.
    const double middle = round < 2 ? double(ring[ring.size() / 2]) : mean;
    const double deviation =
        round < 2 ? 1.4826 * (double(ring[ring.size() / 2]) - double(ring[ring.size() / 4]))
                  : std::sqrt(sky.variance);
    low = middle - 3.5 * deviation, high = middle + 3.5 * deviation;
  }
  return sky;
}

}  // namespace

std::vector<GaussianStar> measure_star_images(const StarPixels& pixels,
                                              std::span<const FoundStar> places, double fwhm_px) {
  constexpr double max_blend = 0.02, min_snr = 30.0;
  const double radius_px = window_radius_px(fwhm_px);
  std::vector<FittedImage> fits;
  std::vector<double> even;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const FoundStar& place = places[k];
    if (!is_within(pixels, place.at, radius_px + 1) || is_clipped(pixels, place, fwhm_px) ||
        light_beside(pixels, places, place, 1.5 * radius_px) > max_blend * place.flux_e)
      continue;
    auto fit = fitted_image(pixels, place, fwhm_px, radius_px);
    if (!fit) continue;
    fit->star.star = k;
    even.push_back(fit->even_variance);
    fits.push_back(std::move(*fit));
  }
  // Most stars are faint: what bright ones have beyond is their difference from a Gaussian.
  const double even_variance = even.empty() ? 0.0 : std::max(median_of(even), 1e-6);
  std::vector<GaussianStar> out;
  for (FittedImage& fit : fits) {
    fit.star.flux_sigma_e = fit.flux.sigma(even_variance);
    fit.star.variance_sigma_px2 = fit.width.sigma(even_variance);
    if (fit.star.flux_e > min_snr * fit.star.flux_sigma_e) out.push_back(fit.star);
  }
  return out;
}

std::optional<StarAperture> aperture_light(
    const StarPixels& pixels, const FoundStar& star, std::span<const FoundStar> strangers,
    std::span<const PixelPosition> others, double fwhm_px,
    const std::function<double(PixelPosition)>& illumination) {
  constexpr double most_beside = 0.003, widths_of_others = 2.5;
  const PixelPosition at = star.at;
  const double radius_px = aperture_widths * fwhm_px, inner_px = radius_px + fwhm_px,
               outer_px = radius_px + 4 * fwhm_px;
  if (!is_within(pixels, at, outer_px) || is_clipped(pixels, star, fwhm_px) ||
      light_beside(pixels, strangers, star, inner_px) > most_beside * star.flux_e)
    return std::nullopt;
  std::vector<PixelPosition> near;
  for (const PixelPosition& other : others)
    if (std::hypot(other.x_px - at.x_px, other.y_px - at.y_px) <
        outer_px + widths_of_others * fwhm_px)
      near.push_back(other);
  const auto is_sky = [&](int x, int y) {
    return std::ranges::none_of(near, [&](const PixelPosition& other) {
      return std::hypot(x - other.x_px, y - other.y_px) < widths_of_others * fwhm_px;
    });
  };
  std::vector<float> ring;
  const double here = illumination(at);
  double sum = 0.0, n = 0.0;  // light in the aperture; pixels by what the lens lets pass there
  const int reach = int(outer_px), cx = int(std::lround(at.x_px)), cy = int(std::lround(at.y_px));
  for (int y = cy - reach; y <= cy + reach; ++y)
    for (int x = cx - reach; x <= cx + reach; ++x) {
      if (!pixels.contains(x, y)) continue;
      const double distance_px = std::hypot(x - at.x_px, y - at.y_px), value = pixels.at(x, y);
      if (distance_px > outer_px || (distance_px > radius_px && distance_px < inner_px)) continue;
      const double passes = illumination({double(x), double(y)}) / here;
      if (distance_px > radius_px) {
        if (std::isfinite(value) && is_sky(x, y)) ring.push_back(float(value / passes));
        continue;
      }
      if (!std::isfinite(value)) return std::nullopt;
      sum += value, n += passes;
    }
  if (ring.size() < 40) return std::nullopt;
  const SkyLevel sky = sky_of(std::move(ring));
  if (!(sky.pixels > 0)) return std::nullopt;
  const double flux = sum - n * sky.mean;
  return StarAperture{flux,
                      std::sqrt(std::max(flux, 0.0) + n * sky.variance * (1 + n / sky.pixels))};
}

}  // namespace dmise
