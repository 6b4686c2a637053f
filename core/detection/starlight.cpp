#include "core/detection/starlight.h"

#include <algorithm>
#include <cmath>

#include "core/detection/components.h"
#include "core/detection/source_fit.h"

namespace dmise {
namespace {

constexpr double starlight_error = 0.05;  // of a star's light in a pixel

/// Half of a Gaussian that sums to 1 as a whole.
std::vector<float> half_of_gaussian(double sigma_px) {
  std::vector<float> half;
  double sum = 0.0;
  for (int i = 0; i <= int(std::ceil(3 * sigma_px)); ++i) {
    half.push_back(float(std::exp(-0.5 * i * i / (sigma_px * sigma_px))));
    sum += (i ? 2.0 : 1.0) * double(half.back());
  }
  for (float& v : half) v /= float(sum);
  return half;
}

/// Convolves values that follow each other by `stride` with half a kernel; there is no light
/// beyond.
void convolve(const float* from, float* to, std::size_t count, std::size_t stride,
              const std::vector<float>& half) {
  const auto n = std::ptrdiff_t(count);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    float sum = half[0] * from[std::size_t(i) * stride];
    for (std::ptrdiff_t k = 1; k < std::ptrdiff_t(half.size()); ++k) {
      if (i >= k) sum += half[std::size_t(k)] * from[std::size_t(i - k) * stride];
      if (i + k < n) sum += half[std::size_t(k)] * from[std::size_t(i + k) * stride];
    }
    to[std::size_t(i) * stride] = sum;
  }
}

}  // namespace

Starlight::Starlight(const Scene& scene)
    : scene_(scene),
      filter_px_(scene.sigma_px),
      unit_(std::sqrt(kernel_square_sum(scene.sigma_px))),
      electrons_(scene.counts.pixels.size()),
      snr_(scene.counts.pixels.size()) {
  filter();
}

void Starlight::filter() {
  const int columns = scene_.counts.columns, rows = scene_.counts.rows;
  std::vector<float> level(std::size_t(columns), 0.0F), rows_smoothed(snr_.size());
  const auto half = half_of_gaussian(filter_px_);
  for (int y = 0; y < rows; ++y) {
    scene_.background.level_row(y, 0, columns, level.data());
    for (int x = 0; x < columns; ++x)
      snr_[index(x, y)] =
          scene_.has_value(x, y) ? float(scene_.counts.at(x, y)) - level[std::size_t(x)] : 0.0F;
    convolve(&snr_[index(0, y)], &rows_smoothed[index(0, y)], std::size_t(columns), 1, half);
  }
  for (int x = 0; x < columns; ++x)
    convolve(&rows_smoothed[index(x, 0)], &snr_[index(x, 0)], std::size_t(rows),
             std::size_t(columns), half);
  for (int y = 0; y < rows; ++y) {
    scene_.background.sigma_row(y, 0, columns, level.data());
    for (int x = 0; x < columns; ++x) snr_[index(x, y)] /= float(unit_) * level[std::size_t(x)];
  }
}

void Starlight::add(const Trail& star, double times) {
  const Psf psf = scene_.psf.at({star.x_px, star.y_px});
  const double noise_e = scene_.noise_e_at(star.x_px, star.y_px);
  const double sigma_px = scene_.psf.sigma_at({star.x_px, star.y_px});
  const double peak = trail_value(star, sigma_px, star.x_px, star.y_px) / noise_e;
  const double reach_px = sigma_px * std::min(14.0, 4.5 + std::log2(std::max(peak, 1.0))) + 1;
  const Around around(star, reach_px);
  const double wide = star.length_px / 2 * std::abs(std::cos(star.angle_rad)) + reach_px;
  const double high = star.length_px / 2 * std::abs(std::sin(star.angle_rad)) + reach_px;
  const int x0 = std::max(0, int(std::ceil(star.x_px - wide))),
            x1 = std::min(scene_.counts.columns - 1, int(std::floor(star.x_px + wide))),
            y0 = std::max(0, int(std::ceil(star.y_px - high))),
            y1 = std::min(scene_.counts.rows - 1, int(std::floor(star.y_px + high)));
  std::vector<FitPixel> pixels;
  for (int y = y0; y <= y1; ++y) {
    const auto [first, last] = around.columns(y);
    for (int x = std::max(x0, first); x <= std::min(x1, last); ++x)
      if (around.has(x, y)) pixels.push_back({x, y});
  }
  if (pixels.empty()) return;
  Psf filtered = psf;
  for (std::size_t i = 0; i < filtered.count; ++i)
    filtered.parts[i].sigma_px = std::hypot(filtered.parts[i].sigma_px, filter_px_);
  const std::vector<double> light = light_in(pixels, {&star, 1}, psf);
  const std::vector<double> through = light_in(pixels, {&star, 1}, filtered);
  const double in_noise = times / (noise_e * unit_);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t at = index(pixels[i].x, pixels[i].y);
    electrons_[at] += float(times * light[i]);
    snr_[at] -= float(in_noise * through[i]);
  }
}

std::vector<FitPixel> Starlight::pixels_less_stars(const Trail& trail, double margin_px) const {
  std::vector<FitPixel> pixels = pixels_near(scene_, trail, margin_px);
  for (FitPixel& p : pixels) {
    const float e = std::max(electrons_[index(p.x, p.y)], 0.0F);
    p.signal_e -= e;
    p.variance_e2 += e + float(starlight_error * starlight_error) * e * e;
  }
  return pixels;
}

}  // namespace dmise
