#include "core/detection/stars/shown_stars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>

#include "core/base/algebra/small_matrix.h"
#include "core/base/numeric/simd_level.h"
#include "core/detection/light/star_image.h"
#include "core/detection/pixels/components.h"

namespace dmise {
namespace {

constexpr double min_light = 0.1;    // a fit has more, relative to what is expected
constexpr double fitted_snr = 10.0;  // fainter stars are not fitted
constexpr float fitted_noise = 0.5;  // light in a pixel [its noise] from which on it is fitted
constexpr float neighbour_noise = 0.1;
constexpr float model_error = 0.03F;  // where stars are not Gaussian, in units of the light
constexpr double max_step_px = 0.7;
constexpr double max_trail_px = 60.0;  // light of longer ones is faint in a pixel
constexpr std::size_t parameters = 3;  // light relative to what is expected, x, y
constexpr std::int32_t min_pixels = 5;

/// The place of a star; ordered by y.
struct Expected {
  float y_px, x_px;
  std::uint32_t star;

  auto operator<=>(const Expected&) const = default;
};

/// Stars in bands of columns, by rows.
class Rows {
 public:
  Rows(const std::vector<ShownStar>& stars, int columns)
      : last_(std::max(columns - 1, 0) / band_px), bands_(std::size_t(last_) + 1) {
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const auto x = float(stars[i].trail.x_px), y = float(stars[i].trail.y_px);
      bands_[std::size_t(band_of(x))].push_back({y, x, std::uint32_t(i)});
    }
    for (auto& band : bands_) std::sort(band.begin(), band.end());
  }

  /// The stars in a rectangle, by rows.
  const std::vector<Expected>& within(float left, float right, float top, float bottom) {
    found_.clear();
    const int first = band_of(left), last = band_of(right);
    for (int b = first; b <= last; ++b) {
      const auto& band = bands_[std::size_t(b)];
      auto star = std::ranges::lower_bound(band, top, {}, &Expected::y_px);
      for (; star != band.end() && star->y_px <= bottom; ++star)
        if (star->x_px >= left && star->x_px <= right) found_.push_back(*star);
    }
    if (first < last) std::sort(found_.begin(), found_.end());
    return found_;
  }

 private:
  static constexpr int band_px = 128;

  int band_of(float x_px) const {
    return int(std::clamp(x_px / float(band_px), 0.0F, float(last_)));
  }

  int last_;
  std::vector<std::vector<Expected>> bands_;
  std::vector<Expected> found_;
};

/// Calls visit(star) for the stars with light in an image, except the star `own`.
template <class Visit>
void for_neighbours(const std::vector<ShownStar>& stars, Rows& rows, const StarImage& image,
                    float reach_px, std::size_t own, const Visit& visit) {
  for (const Expected& near : rows.within(float(image.x0) - reach_px, float(image.x1) + reach_px,
                                          float(image.y0) - reach_px, float(image.y1) + reach_px))
    if (near.star != own) visit(stars[near.star]);
}

/// Fits stars one after the other.
class StarFitter {
 public:
  StarFitter(const Scene& scene, double place_sigma_px)
      : scene_(scene),
        place_weight_(1 / (place_sigma_px * place_sigma_px)),
        image_(scene.counts.columns, scene.counts.rows),
        beside_(scene.counts.columns, scene.counts.rows) {}

  /// Fits a star whose light is at least `least` of what is expected. Returns whether it could.
  bool fit(std::vector<ShownStar>& stars, Rows& rows, std::size_t i, double least) {
    ShownStar& star = stars[i];
    const double sigma_px = scene_.psf.sigma_at({star.trail.x_px, star.trail.y_px});
    image_.draw_with_slopes(star.trail, sigma_px, star.flux_e / star.noise_e, fitted_noise);
    if (image_.x1 < image_.x0 || image_.y1 < image_.y0) return false;
    read_pixels(star.noise_e);
    const auto reach_px = float(4 * sigma_px + star.trail.length_px / 2 + max_step_px);
    for_neighbours(stars, rows, image_, reach_px, i, [&](const ShownStar& other) {
      beside_.draw(other.trail, sigma_px, other.flux_e / star.noise_e, neighbour_noise);
      subtract_beside();
    });
    return solve_for(star, least);
  }

 private:
  /// Signal in units of noise; pixels that are not used become NaN.
  void read_pixels(double noise_e) {
    const std::size_t stride = image_.stride(), width = image_.width();
    pixels_.assign(stride * image_.height(), NAN);
    const auto unit = float(scene_.gain_e_per_dn / noise_e);
    const int middle = (image_.x0 + image_.x1) / 2;
    const bool whole = is_whole();
    float* pixel = pixels_.data();
    for (int y = image_.y0; y <= image_.y1; ++y, pixel += stride) {
      const float* light = image_.row(y);
      const float level_dn = scene_.background.level_dn(middle, y);
      const std::uint16_t* counts = scene_.counts.row(y) + image_.x0;
      for (std::size_t k = 0; k < width; ++k) {
        const bool used =
            light[k] >= fitted_noise && (whole || scene_.is_usable(image_.x0 + int(k), y));
        pixel[k] = used ? (float(counts[k]) - level_dn) * unit : NAN;
      }
    }
  }

  /// Whether all pixels of the image are usable: none in it or beside it is clipped.
  bool is_whole() const {
    if (scene_.unusable || scene_.hidden || scene_.known) return false;
    std::uint16_t most = 0;
    const int last = std::min(image_.y1 + 1, scene_.counts.rows - 1);
    for (int y = std::max(image_.y0 - 1, 0); y <= last; ++y) {
      const std::uint16_t* counts = scene_.counts.row(y);
      for (int x = image_.x0; x <= image_.x1; ++x) most = std::max(most, counts[x]);
    }
    return most < scene_.saturation_dn;
  }

  void subtract_beside() {
    const int x0 = std::max(image_.x0, beside_.x0), x1 = std::min(image_.x1, beside_.x1);
    for (int y = std::max(image_.y0, beside_.y0); y <= std::min(image_.y1, beside_.y1); ++y) {
      float* row = pixels_.data() + std::size_t(y - image_.y0) * image_.stride();
      for (int x = x0; x <= x1; ++x) row[x - image_.x0] -= beside_.row(y)[x - beside_.x0];
    }
  }

  bool solve_for(ShownStar& star, double least) const {
    static const auto add_pixels =
        kernel_of(best_simd_level(), sse2::add_pixels, avx2::add_pixels, avx512::add_pixels);
    StarSums sums;
    add_pixels(image_.row(image_.y0), image_.row_by_x(image_.y0), image_.row_by_y(image_.y0),
               pixels_.data(), image_.stride(), image_.height(), float(1 / star.noise_e),
               model_error, sums);
    if (sums.used < min_pixels) return false;
    SmallMatrix matrix{};
    SmallVector right{};
    for (std::size_t a = 0; a < parameters; ++a) {
      right[a] = sums.right[a];
      for (std::size_t b = 0; b <= a; ++b) matrix[a][b] = sums.matrix[a * (a + 1) / 2 + b];
    }
    matrix[0][0] += 1 / (star.light_error * star.light_error);
    matrix[1][1] += place_weight_;
    matrix[2][2] += place_weight_;
    if (!cholesky(matrix, parameters)) return false;
    const SmallVector step = solve(matrix, right, parameters);
    if (std::hypot(step[1], step[2]) > max_step_px || !(step[0] > least - 1)) return false;
    star.light_error =
        std::hypot(std::sqrt(inverse_column(matrix, 0, parameters)[0]), double(model_error));
    star.flux_e *= 1 + step[0];
    star.trail.x_px += step[1];
    star.trail.y_px += step[2];
    return true;
  }

  const Scene& scene_;
  double place_weight_;
  StarImage image_, beside_;
  std::vector<float> pixels_;
};

}  // namespace

std::vector<ShownStar> shown_stars(const Scene& scene, const StarAgreement& agreement,
                                   const std::vector<ExpectedStar>& expected) {
  std::vector<ShownStar> stars;
  stars.reserve(expected.size());
  for (const ExpectedStar& star : expected) {
    const PixelPosition at = star.place + agreement.seen().shift;
    const StarLightRatio& light = agreement.light_at(at);
    stars.push_back({scene.star_trail(at.x_px, at.y_px), scene.noise_e_at(at.x_px, at.y_px),
                     light.middle * star.signal_e, light.scatter});
  }
  Rows rows(stars, scene.counts.columns);
  StarFitter fitter(scene, agreement.seen().scatter_px);
  const double unit = std::sqrt(kernel_square_sum(scene.sigma_px));
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const ShownStar& star = stars[i];
    const double snr = unit * star.flux_e / star.noise_e;
    const bool may_be_fitted = star.trail.length_px < max_trail_px;
    if (!expected[i].varies()) {
      if (snr > fitted_snr && may_be_fitted) fitter.fit(stars, rows, i, min_light);
      continue;
    }
    const ShownStar unfitted = star;
    stars[i].light_error += std::max(expected[i].most - 1.0, 1.0 - expected[i].least);
    if (snr * expected[i].most > fitted_snr && may_be_fitted && fitter.fit(stars, rows, i, 0.0))
      continue;
    stars[i] = unfitted;
    stars[i].most = expected[i].most;
  }
  return stars;
}

}  // namespace dmise
