#include "core/detection/source/residual_frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/detection/pixels/components.h"
#include "core/detection/source/source_fit.h"

namespace dmise {

ResidualFrame::ResidualFrame(const Scene& scene, PointSnrImage snr)
    : scene_(scene),
      filtered_noise_(std::sqrt(kernel_square_sum(scene.sigma_px))),
      light_(scene.counts.columns, scene.counts.rows),
      snr_(std::move(snr)) {}

/// Pixels that a star lights: the brighter it is, the farther its wings.
std::vector<FitPixel> ResidualFrame::pixels_with_light(const Trail& star) const {
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

void ResidualFrame::add(const Trail& star, double times) {
  const auto pixels = pixels_with_light(star);
  const Psf psf = scene_.psf.at({star.x_px, star.y_px});
  const auto light = light_in(pixels, {&star, 1}, psf);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    light_.at(pixels[i].x, pixels[i].y) += float(times * light[i]);
  if (snr_.pixels.empty()) return;
  Psf filtered = psf;
  for (std::size_t i = 0; i < filtered.count; ++i)
    filtered.parts[i].sigma_px = std::hypot(filtered.parts[i].sigma_px, scene_.sigma_px);
  const auto filtered_light = light_in(pixels, {&star, 1}, filtered);
  const double in_noise = times / (scene_.noise_e_at(star.x_px, star.y_px) * filtered_noise_);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    snr_.at(pixels[i].x, pixels[i].y) -= float(in_noise * filtered_light[i]);
}

std::vector<FitPixel> ResidualFrame::pixels_around(const Trail& trail, double margin_px) const {
  std::vector<FitPixel> pixels = pixels_near(scene_, trail, margin_px);
  for (FitPixel& p : pixels) {
    const float e = std::max(light_e(p.x, p.y), 0.0F);
    p.signal_e -= e;
    p.variance_e2 += variance_e2(e);
  }
  return pixels;
}

}  // namespace dmise
