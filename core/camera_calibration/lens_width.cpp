#include "core/camera_calibration/lens_width.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/algebra/positive_matrix.h"
#include "core/base/numeric/quantile.h"
#include "core/camera_calibration/frame_scatter.h"

namespace dmise {
namespace {

constexpr std::size_t width_terms = 5;  // level, two of the radial and two of the tangential width
constexpr std::size_t width_parts = 32, min_stars = 8, min_field_stars = 24;
constexpr int width_nodes = 5;
using WidthSums = StripSums<width_terms * width_terms + width_terms>;
using WidthTerms = std::array<double, width_terms>;

/// How a width may change over the field: not, alike along and across the radius, or not alike.
enum class WidthModel : std::size_t { even = 1, round = 3, free = 5 };

WidthTerms width_row(WidthModel model, bool tangential, double t) {
  if (model == WidthModel::even) return {1.0};
  if (model == WidthModel::round || !tangential) return {1.0, t, t * t};
  return {1.0, 0.0, 0.0, t, t * t};
}

/// A star's variances along and across the radius.
struct RadialImage {
  double t = 0.0;  // square of the radius over that of the corner
  std::array<double, 2> px2{};
  double variance = 0.0;  // as the star's own width gives it
  std::size_t frame = 0;
  // As a star of the expected width has them: what it is off, and its variance.
  double off = 0.0, noise = 0.0, weight = 0.0;

  double mean_px2() const { return 0.5 * (px2[0] + px2[1]); }
  /// A star that noise has made narrow claims less noise, and would weigh more than one made wide:
  /// with noise of pixels alone the variance of a width is as its cube over the square of the
  /// light, which is fitted as the root of the width.
  void expect(double width_px2) {
    constexpr double of_pixel = 1.0 / 12;
    off = mean_px2() - width_px2;
    noise = variance * std::pow((width_px2 + of_pixel) / (mean_px2() + of_pixel), 2);
  }
};

std::optional<WidthTerms> terms_of(const WidthSums& sums, WidthModel model) {
  const auto n = std::size_t(model);
  std::vector<double> matrix(n * n);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) matrix[a * n + b] = sums[a * width_terms + b];
  if (!invert_positive(matrix, int(n))) return std::nullopt;
  WidthTerms out{};
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      out[a] += matrix[a * n + b] * sums[width_terms * width_terms + b];
  return out;
}

/// Deviation of what a linear function makes of the terms, by the weights: each star's is that of
/// the mean of its two sides.
template <class Function>
double sigma_by_weights(const std::vector<WidthSums>& parts, WidthModel model,
                        Function&& value_of) {
  const auto n = std::size_t(model);
  std::vector<double> matrix(n * n, 0.0);
  for (const WidthSums& part : parts)
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) matrix[a * n + b] += part[a * width_terms + b];
  if (!invert_positive(matrix, int(n))) return 0.0;
  WidthTerms by{};
  for (std::size_t a = 0; a < n; ++a) {
    WidthTerms one{};
    one[a] = 1.0;
    by[a] = value_of(one);
  }
  double variance = 0.0;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) variance += by[a] * matrix[a * n + b] * by[b];
  return std::sqrt(2 * variance);
}

double width_at(const WidthTerms& terms, WidthModel model, bool tangential, double t) {
  const WidthTerms row = width_row(model, tangential, t);
  double sum = 0.0;
  for (std::size_t a = 0; a < width_terms; ++a) sum += row[a] * terms[a];
  return sum;
}

std::vector<WidthSums> width_sums(const std::vector<RadialImage>& images, WidthModel model) {
  std::vector<WidthSums> parts(std::min(width_parts, images.size()));
  for (std::size_t k = 0; k < images.size(); ++k)
    for (std::size_t side = 0; side < 2; ++side) {
      const WidthTerms row = width_row(model, side == 1, images[k].t);
      WidthSums& s = parts[k % parts.size()];
      for (std::size_t a = 0; a < width_terms; ++a) {
        for (std::size_t b = 0; b < width_terms; ++b)
          s[a * width_terms + b] += images[k].weight * row[a] * row[b];
        s[width_terms * width_terms + a] += images[k].weight * row[a] * images[k].px2[side];
      }
    }
  return parts;
}

double mean_width_at(const WidthTerms& terms, WidthModel model, double t) {
  return 0.5 * (width_at(terms, model, false, t) + width_at(terms, model, true, t));
}

/// Weights by the stars' scatter about a fit beside their noise; takes out what is far from it.
/// Returns the deviation by which frames differ.
double weigh(WidthModel model, std::vector<RadialImage>& images) {
  constexpr double outlier_sigmas_of_width = 4.5, min_variance = 1e-6;
  std::vector<double> widths;
  for (const RadialImage& image : images) widths.push_back(image.mean_px2());
  WidthTerms last{median_of(std::move(widths))};
  const auto expect_all = [&] {
    for (RadialImage& image : images) image.expect(mean_width_at(last, model, image.t));
    const double max_px4 = last[0] * last[0];
    return scatter_beside(
        images, [](const RadialImage& image) { return image.off; },
        [](const RadialImage& image) { return image.noise; }, min_variance, max_px4);
  };
  for (int round = 0; round < 6; ++round) {
    const double scatter2 = expect_all();
    std::size_t kept = 0;
    for (const RadialImage& image : images)
      if (std::abs(image.off) < outlier_sigmas_of_width * std::sqrt(image.noise + scatter2))
        images[kept++] = image;
    if (round > 1 && kept >= min_stars) images.resize(kept);
    for (RadialImage& image : images) image.weight = 1 / (image.noise + scatter2);
    WidthSums all{};
    for (const WidthSums& part : width_sums(images, model))
      for (std::size_t k = 0; k < all.size(); ++k) all[k] += part[k];
    const auto terms = terms_of(all, model);
    if (!terms) return 0.0;
    last = *terms;
  }
  std::vector<FrameResidual> residuals;
  for (const RadialImage& image : images)
    residuals.push_back(
        {image.frame, image.mean_px2() - mean_width_at(last, model, image.t), 1 / image.weight});
  return deviation_by_frames(residuals);
}

std::vector<RadialImage> radial_images(std::span<const GaussianStar> images, int columns,
                                       int rows) {
  const double x = 0.5 * (columns - 1), y = 0.5 * (rows - 1), corner = std::hypot(x, y);
  std::vector<RadialImage> stars;
  for (const GaussianStar& image : images) {
    const double dx = image.at.x_px - x, dy = image.at.y_px - y, r = std::hypot(dx, dy);
    const double c = r > 0 ? dx / r : 1.0, s = r > 0 ? dy / r : 0.0;
    const double radial = c * c * image.xx_px2 + 2 * c * s * image.xy_px2 + s * s * image.yy_px2;
    stars.push_back({.t = r * r / (corner * corner),
                     .px2 = {radial, image.xx_px2 + image.yy_px2 - radial},
                     .variance = image.variance_sigma_px2 * image.variance_sigma_px2,
                     .frame = image.frame});
  }
  return stars;
}

}  // namespace

std::optional<double> usual_variance_px2(std::span<const GaussianStar> images, int columns,
                                         int rows) {
  constexpr double usual_t = 1.0 / 3;
  std::vector<RadialImage> stars = radial_images(images, columns, rows);
  if (stars.size() < min_stars) return std::nullopt;
  const WidthModel model = stars.size() >= min_field_stars ? WidthModel::round : WidthModel::even;
  weigh(model, stars);
  WidthSums all{};
  for (const WidthSums& part : width_sums(stars, model))
    for (std::size_t k = 0; k < all.size(); ++k) all[k] += part[k];
  const auto terms = terms_of(all, model);
  if (!terms) return std::nullopt;
  return mean_width_at(*terms, model, usual_t);
}

std::optional<LensWidth> measure_width(std::span<const GaussianStar> images, int columns,
                                       int rows) {
  const double corner = std::hypot(0.5 * (columns - 1), 0.5 * (rows - 1));
  std::vector<RadialImage> stars = radial_images(images, columns, rows);
  if (stars.size() < min_stars) return std::nullopt;
  const bool has_field = stars.size() >= min_field_stars;
  const double by_frames = weigh(has_field ? WidthModel::round : WidthModel::even, stars);
  // A few bright stars may hold most of the weight: leaving out parts does not show their scatter.
  const auto measured = [&](WidthModel model, auto&& value_of) {
    const auto parts = width_sums(stars, model);
    MeasuredValue m = jackknifed(parts, [&](const WidthSums& sums) {
      return value_of(terms_of(sums, model).value_or(WidthTerms{}));
    });
    m.sigma = std::max(m.sigma, sigma_by_weights(parts, model, value_of));
    return m;
  };
  const auto of_all = [&](WidthModel model, auto&& value_of) {
    const MeasuredValue m = measured(model, value_of);
    return MeasuredValue{m.value, std::hypot(m.sigma, by_frames)};
  };
  LensWidth out{.even_px2 = of_all(WidthModel::even, [](const WidthTerms& w) { return w[0]; })};
  if (!has_field || stars.size() < min_field_stars) return out;
  for (int node = 0; node < width_nodes; ++node) {
    const double r = double(node) / (width_nodes - 1), t = r * r;
    const auto at = [t](WidthModel model, bool tangential) {
      return [=](const WidthTerms& w) { return width_at(w, model, tangential, t); };
    };
    out.field.push_back({.radius_px = r * corner,
                         .radial_px2 = of_all(WidthModel::free, at(WidthModel::free, false)),
                         .tangential_px2 = of_all(WidthModel::free, at(WidthModel::free, true)),
                         .mean_px2 = of_all(WidthModel::round, at(WidthModel::round, false))});
  }
  out.growth_px2 = measured(WidthModel::round, [](const WidthTerms& w) { return w[1] + w[2]; });
  out.elongation_px2 =
      measured(WidthModel::free, [](const WidthTerms& w) { return w[1] + w[2] - w[3] - w[4]; });
  return out;
}

}  // namespace dmise
