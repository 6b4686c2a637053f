#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "sensors/render/tile_mesh.h"

namespace dmise {

/// Samples of the tile that a rasteriser gives to triangles, against their areas: the grid sees a
/// little more or less of a narrow shape than there is, which is put right by its radiance.
class SampleCount {
 public:
  using Triangle = std::array<Vec<CameraFrame>, 3>;

  SampleCount(const TileCamera& camera, int oversampling)
      : camera_(camera), oversampling_(oversampling) {}

  void add(const Triangle& p) {
    std::array<double, 3> x, y;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(p[i].z > 0.0)) inside_ = false;
      x[i] = camera_.principal_x_px - camera_.left + 0.5 + camera_.focal_px * p[i].x / p[i].z;
      y[i] = camera_.principal_y_px - camera_.top + 0.5 + camera_.focal_px * p[i].y / p[i].z;
      if (!(x[i] >= 0.0 && y[i] >= 0.0 && x[i] <= camera_.columns && y[i] <= camera_.rows))
        inside_ = false;
      x[i] *= oversampling_;
      y[i] *= oversampling_;
    }
    if (!inside_) return;
    const double twice = std::abs((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]));
    for (std::size_t i = 0; i < 3; ++i)
      longest_ = std::max(longest_, std::hypot(x[(i + 1) % 3] - x[i], y[(i + 1) % 3] - y[i]));
    area_ += twice / 2.0;
    // Rasterisers snap corners to 1/256 of a sample.
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = std::round(x[i] * 256.0) / 256.0;
      y[i] = std::round(y[i] * 256.0) / 256.0;
    }
    const auto [low, high] = std::minmax({y[0], y[1], y[2]});
    for (double row = std::ceil(low - 0.5) + 0.5; row < high; row += 1.0) add_row(x, y, row);
  }

  /// Of triangles that are long and at most 32 samples wide.
  bool narrow() const {
    const double width = longest_ > 0.0 ? 2.0 * area_ / longest_ : 0.0;
    return width < 32.0 && longest_ > 2.5 * width;
  }

  /// Wholly in the tile with too few samples to tell.
  bool sparse() const { return inside_ && count_ < fewest; }
  double area() const { return area_; }  // in samples

  /// Area over samples; 1 for what is not wholly in the tile or has too few samples to tell.
  double correction() const { return inside_ && count_ >= fewest ? area_ / count_ : 1.0; }

 private:
  void add_row(const std::array<double, 3>& x, const std::array<double, 3>& y, double row) {
    double left = 1e300, right = -1e300;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if ((y[i] <= row) == (y[j] <= row)) continue;
      const double at = x[i] + (x[j] - x[i]) * (row - y[i]) / (y[j] - y[i]);
      left = std::min(left, at);
      right = std::max(right, at);
    }
    if (right > left) count_ += std::ceil(right - 0.5) - std::ceil(left - 0.5);
  }

  static constexpr double fewest = 12.0;
  TileCamera camera_;
  double oversampling_;
  double area_ = 0.0, count_ = 0.0, longest_ = 0.0;
  bool inside_ = true;
};

}  // namespace dmise
