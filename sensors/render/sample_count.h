#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "sensors/render/tile_mesh.h"

namespace dmise {

/// Compares the number of samples that a rasteriser assigns to triangles with their area: the grid
/// over- or underestimates narrow shapes, which is corrected in their radiance.
class SampleCount {
 public:
  using Triangle = std::array<glm::dvec3, 3>;  // corners in camera axes [m]

  SampleCount(const TileCamera& camera, int oversampling)
      : camera_(camera), oversampling_(oversampling) {}

  void add(const Triangle& p) {
    const glm::dvec2 edge_px(camera_.columns, camera_.rows);
    const glm::dvec2 origin_px(camera_.principal_x_px - camera_.left + 0.5,
                               camera_.principal_y_px - camera_.top + 0.5);
    std::array<glm::dvec2, 3> at;  // [samples]
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 place_px = origin_px + camera_.focal_px * glm::dvec2(p[i]) / p[i].z;
      if (!(p[i].z > 0.0 && glm::all(glm::greaterThanEqual(place_px, glm::dvec2(0.0))) &&
            glm::all(glm::lessThanEqual(place_px, edge_px))))
        inside_ = false;
      at[i] = place_px * oversampling_;
    }
    if (!inside_) return;
    area_ += std::abs(glm::determinant(glm::dmat2(at[1] - at[0], at[2] - at[0]))) / 2.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 side = at[(i + 1) % 3] - at[i];
      longest_ = std::max(longest_, std::hypot(side.x, side.y));
    }
    // Rasterisers snap corners to 1/256 of a sample.
    for (glm::dvec2& corner : at)
      corner = glm::dvec2(std::round(corner.x * 256.0), std::round(corner.y * 256.0)) / 256.0;
    const auto [low, high] = std::minmax({at[0].y, at[1].y, at[2].y});
    for (double row = std::ceil(low - 0.5) + 0.5; row < high; row += 1.0) add_row(at, row);
  }

  /// Whether the triangles are long and at most 32 samples wide.
  bool narrow() const { return width() < 32.0 && longest_ > 2.5 * width(); }

  /// Entirely in the tile with too few samples: of a sliver between two rows of them, rounding
  /// decides whether it has any.
  bool sparse() const { return inside_ && (count_ < fewest || width() < narrowest); }
  double longest() const { return longest_; }  // side, in samples
  double area() const { return area_; }        // in samples

  /// Area per sample; 1 if not entirely in the tile or with too few samples.
  double correction() const { return inside_ && count_ >= fewest ? area_ / count_ : 1.0; }

 private:
  void add_row(const std::array<glm::dvec2, 3>& corner, double row) {
    double left = 1e300, right = -1e300;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 &a = corner[i], &b = corner[(i + 1) % 3];
      if ((a.y <= row) == (b.y <= row)) continue;
      const double x = a.x + (b.x - a.x) * (row - a.y) / (b.y - a.y);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (right > left) count_ += std::ceil(right - 0.5) - std::ceil(left - 0.5);
  }

  double width() const { return longest_ > 0.0 ? 2.0 * area_ / longest_ : 0.0; }

  static constexpr double fewest = 12.0, narrowest = 2.0;
  TileCamera camera_;
  double oversampling_;
  double area_ = 0.0, count_ = 0.0, longest_ = 0.0;
  bool inside_ = true;
};

}  // namespace dmise
