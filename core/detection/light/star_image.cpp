#include "core/detection/light/star_image.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/simd_level.h"
#include "core/base/units.h"

namespace dmise {

void StarImage::draw(const Trail& t, double sigma_px, double flux, double least, bool with_slopes) {
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
  stride_ = (width() + star_lanes - 1) / star_lanes * star_lanes;
  const auto make_room = [](std::vector<float>& values, std::size_t count) {
    if (values.size() < count) values.resize(count);
  };
  make_room(light_, stride_ * height());
  if (with_slopes) make_room(by_x_, stride_ * height()), make_room(by_y_, stride_ * height());
  make_room(scratch_, std::size_t(points) * (stride_ + height() + star_lanes));
  points_.clear();
  for (int i = 0; i < points; ++i) {
    // The middles of equal parts have the trail's spread but for a part's own.
    const double along = ((i + 0.5) / points - 0.5) * t.length_px;
    const double cx = t.x_px + along * ux - x0, cy = t.y_px + along * uy - y0;
    const auto end = [&](double place, std::size_t pixels) {
      return std::int32_t(std::clamp(place, -1.0, double(pixels)));
    };
    // No column beyond the box has light, though its row has room for it.
    points_.push_back({float(cx), float(cy), end(std::ceil(cx - reach), width()),
                       std::min(end(std::floor(cx + reach), width()), std::int32_t(width()) - 1),
                       end(std::ceil(cy - reach), height()),
                       end(std::floor(cy + reach), height())});
  }
  static const auto draw_points =
      kernel_of(best_simd_level(), sse2::draw_points, avx2::draw_points, avx512::draw_points);
  const StarCanvas to{stride_,
                      height(),
                      light_.data(),
                      with_slopes ? by_x_.data() : nullptr,
                      with_slopes ? by_y_.data() : nullptr,
                      scratch_.data()};
  draw_points(points_.data(), points_.size(), float(each), float(-0.5 / (sigma_px * sigma_px)), to);
}

}  // namespace dmise
