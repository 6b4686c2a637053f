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

/// Convolves a row with half a kernel; there is no light beyond.
void convolve_row(const float* from, float* to, int count, const std::vector<float>& half) {
  for (int i = 0; i < count; ++i) to[i] = half[0] * from[i];
  for (int k = 1; k < std::min(count, int(half.size())); ++k) {
    const float weight = half[std::size_t(k)];
    for (int i = k; i < count; ++i) to[i] += weight * from[i - k];
    for (int i = 0; i + k < count; ++i) to[i] += weight * from[i + k];
  }
}

/// One row of the convolution of columns, in whole rows, as they lie in memory.
void convolve_columns(const std::vector<float>& from, float* to, int columns, int rows, int y,
                      const std::vector<float>& half) {
  const auto row = [&](int j) { return &from[std::size_t(j) * std::size_t(columns)]; };
  const auto add = [&](const float* values, float weight) {
    for (int x = 0; x < columns; ++x) to[x] += weight * values[x];
  };
  std::fill_n(to, columns, 0.0F);
  add(row(y), half[0]);
  for (int k = 1; k < int(half.size()); ++k) {
    if (y >= k) add(row(y - k), half[std::size_t(k)]);
    if (y + k < rows) add(row(y + k), half[std::size_t(k)]);
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
  std::vector<float> level(std::size_t(columns), 0.0F), excess = level, smoothed(snr_.size());
  const auto half = half_of_gaussian(filter_px_);
  for (int y = 0; y < rows; ++y) {
    scene_.background.level_row(y, 0, columns, level.data());
    for (int x = 0; x < columns; ++x)
      excess[std::size_t(x)] =
          scene_.has_value(x, y) ? float(scene_.counts.at(x, y)) - level[std::size_t(x)] : 0.0F;
    convolve_row(excess.data(), &smoothed[index(0, y)], columns, half);
  }
  for (int y = 0; y < rows; ++y) {
    convolve_columns(smoothed, &snr_[index(0, y)], columns, rows, y, half);
    scene_.background.sigma_row(y, 0, columns, level.data());
    for (int x = 0; x < columns; ++x) snr_[index(x, y)] /= float(unit_) * level[std::size_t(x)];
  }
}

std::vector<FitPixel> Starlight::reached_by(const Trail& star) const {
  const double noise_e = scene_.noise_e_at(star.x_px, star.y_px);
  const double sigma_px = scene_.psf.sigma_at({star.x_px, star.y_px});
  const double peak = trail_value(star, sigma_px, star.x_px, star.y_px) / noise_e;
  const double reach_px = sigma_px * std::min(14.0, 4.5 + std::log2(std::max(peak, 1.0))) + 1;
  const Around around(star, reach_px);
  std::vector<FitPixel> pixels;
  around.for_rows(scene_.counts.columns, scene_.counts.rows, [&](int y, int begin, int end) {
    for (int x = begin; x < end; ++x)
      if (around.has(x, y)) pixels.push_back({x, y});
  });
  return pixels;
}

void Starlight::add_electrons(const Trail& star, double times) {
  const auto pixels = reached_by(star);
  const auto light = light_in(pixels, {&star, 1}, scene_.psf.at({star.x_px, star.y_px}));
  for (std::size_t i = 0; i < pixels.size(); ++i)
    electrons_[index(pixels[i].x, pixels[i].y)] += float(times * light[i]);
}

void Starlight::add(const Trail& star, double times) {
  const auto pixels = reached_by(star);
  const Psf psf = scene_.psf.at({star.x_px, star.y_px});
  Psf filtered = psf;
  for (std::size_t i = 0; i < filtered.count; ++i)
    filtered.parts[i].sigma_px = std::hypot(filtered.parts[i].sigma_px, filter_px_);
  const std::vector<double> light = light_in(pixels, {&star, 1}, psf);
  const std::vector<double> through = light_in(pixels, {&star, 1}, filtered);
  const double in_noise = times / (scene_.noise_e_at(star.x_px, star.y_px) * unit_);
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
