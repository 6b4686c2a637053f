#include "core/detection/star_image.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {

template <bool with_slopes>
void StarImage::draw_points(const Trail& t, double sigma_px, double flux, double least) {
  const int points = 1 + int(std::ceil(t.length_px / (0.8 * sigma_px)));
  const double each = flux / (2 * pi * sigma_px * sigma_px * points);
  const double reach = sigma_px * std::sqrt(2 * std::log(std::max(each * points / least, 1.01)));
  const double ux = std::cos(t.angle_rad), uy = std::sin(t.angle_rad), half = t.length_px / 2;
  const auto within = [](double place, int pixels) {
    return int(std::clamp(place, -1.0, double(pixels)));
  };
  x0 = std::max(0, within(std::ceil(t.x_px - half * std::abs(ux) - reach), columns_));
  x1 = std::min(columns_ - 1, within(std::floor(t.x_px + half * std::abs(ux) + reach), columns_));
  y0 = std::max(0, within(std::ceil(t.y_px - half * std::abs(uy) - reach), rows_));
  y1 = std::min(rows_ - 1, within(std::floor(t.y_px + half * std::abs(uy) + reach), rows_));
  if (x1 < x0 || y1 < y0) return;
  const auto width = std::size_t(x1 - x0 + 1);
  const std::size_t pixels = width * std::size_t(y1 - y0 + 1);
  light_.assign(pixels, 0.0F);
  if (with_slopes) by_x_.assign(pixels, 0.0F), by_y_.assign(pixels, 0.0F);
  across_.resize(width);
  const double k = -0.5 / (sigma_px * sigma_px);
  for (int i = 0; i < points; ++i) {
    // The middles of equal parts have the trail's spread but for a part's own.
    const double along = ((i + 0.5) / points - 0.5) * t.length_px;
    const double cx = t.x_px + along * ux, cy = t.y_px + along * uy;
    const int left = std::max(x0, within(std::ceil(cx - reach), columns_));
    const int right = std::min(x1, within(std::floor(cx + reach), columns_));
    const int top = std::max(y0, within(std::ceil(cy - reach), rows_));
    const int bottom = std::min(y1, within(std::floor(cy + reach), rows_));
    for (int x = left; x <= right; ++x)
      across_[std::size_t(x - x0)] = float(each * std::exp(k * (x - cx) * (x - cx)));
    for (int y = top; y <= bottom; ++y) {
      const auto down = float(std::exp(k * (y - cy) * (y - cy)));
      float* row = light_.data() + offset(y);
      for (int x = left; x <= right; ++x) row[x - x0] += across_[std::size_t(x - x0)] * down;
      if (!with_slopes) continue;
      const auto steepness = float(-2 * k);
      const float up = steepness * float(y - cy);
      for (int x = left; x <= right; ++x) {
        const std::size_t i_x = offset(y) + std::size_t(x - x0);
        const float light = across_[std::size_t(x - x0)] * down;
        by_x_[i_x] += steepness * float(x - cx) * light;
        by_y_[i_x] += up * light;
      }
    }
  }
}

void StarImage::draw(const Trail& trail, double sigma_px, double flux, double least) {
  draw_points<false>(trail, sigma_px, flux, least);
}

void StarImage::draw_with_slopes(const Trail& trail, double sigma_px, double flux, double least) {
  draw_points<true>(trail, sigma_px, flux, least);
}

}  // namespace dmise
