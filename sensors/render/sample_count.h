#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

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
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 place_px = origin_px + camera_.focal_px * glm::dvec2(p[i]) / p[i].z;
      if (!(p[i].z > 0.0)) in_front_ = false;
      if (!(glm::all(glm::greaterThanEqual(place_px, glm::dvec2(0.0))) &&
            glm::all(glm::lessThanEqual(place_px, edge_px))))
        inside = false;
      at[i] = place_px * oversampling_;
      low_ = glm::min(low_, at[i]);
      high_ = glm::max(high_, at[i]);
    }
    if (!in_front_) return;
    inside_ = inside_ && inside;
    const double area = std::abs(glm::determinant(glm::dmat2(at[1] - at[0], at[2] - at[0]))) / 2.0;
    whole_area_ += area;
    edge_ = edge_px * oversampling_;
    area_ += inside ? area : area_in_tile(at);
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 side = at[(i + 1) % 3] - at[i];
      longest_ = std::max(longest_, std::hypot(side.x, side.y));
    }
    // Rasterisers snap corners to 1/256 of a sample.
    for (glm::dvec2& corner : at)
      corner = glm::dvec2(std::round(corner.x * 256.0), std::round(corner.y * 256.0)) / 256.0;
    const auto [low, high] = std::minmax({at[0].y, at[1].y, at[2].y});
    const double end = std::min(high, edge_.y);
    for (double row = std::ceil(std::max(low, 0.0) - 0.5) + 0.5; row < end; row += 1.0)
      add_row(at, row);
  }

  /// Whether the triangles are long and at most 32 samples wide.
  bool narrow() const { return width() < 32.0 && longest_ > 2.5 * width(); }

  /// Before the camera with too few samples: of a sliver between two rows of them, rounding
  /// decides whether it has any.
  bool sparse() const { return in_front_ && (width() < narrowest || (inside_ && count_ < fewest)); }
  /// Before the camera, and whether its bounding box is beside the tile.
  bool beside() const {
    return in_front_ && (high_.x < 0.0 || high_.y < 0.0 || low_.x > edge_.x || low_.y > edge_.y);
  }
  double longest() const { return longest_; }        // side, in samples
  double whole_area() const { return whole_area_; }  // in samples, the part beside the tile, too

  /// Area in the tile per sample; 1 if not before the camera or with too few samples.
  double correction() const { return in_front_ && count_ >= fewest ? area_ / count_ : 1.0; }

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
    left = std::max(left, 0.0);
    right = std::min(right, edge_.x);
    if (right > left) count_ += std::ceil(right - 0.5) - std::ceil(left - 0.5);
  }

  /// Area of what the tile's sides leave of a triangle (Sutherland & Hodgman 1974).
  double area_in_tile(const std::array<glm::dvec2, 3>& triangle) const {
    std::vector<glm::dvec2> part(triangle.begin(), triangle.end()), left;
    for (const auto& [axis, sign, limit] :
         {std::tuple(0, -1.0, 0.0), {0, 1.0, edge_.x}, {1, -1.0, 0.0}, {1, 1.0, edge_.y}}) {
      left.clear();
      for (std::size_t i = 0; i < part.size(); ++i) {
        const glm::dvec2 &a = part[i], &b = part[(i + 1) % part.size()];
        const double out_a = sign * (a[axis] - limit), out_b = sign * (b[axis] - limit);
        if (out_a <= 0.0) left.push_back(a);
        if ((out_a <= 0.0) != (out_b <= 0.0))
          left.push_back(a + (b - a) * (out_a / (out_a - out_b)));
      }
      part.swap(left);
    }
    double twice = 0.0;
    for (std::size_t i = 1; i + 1 < part.size(); ++i)
      twice += glm::determinant(glm::dmat2(part[i] - part[0], part[i + 1] - part[0]));
    return std::abs(twice) / 2.0;
  }

  double width() const { return longest_ > 0.0 ? 2.0 * whole_area_ / longest_ : 0.0; }

  static constexpr double fewest = 12.0, narrowest = 2.0;
  TileCamera camera_;
  double oversampling_;
  double whole_area_ = 0.0, longest_ = 0.0;
  double area_ = 0.0, count_ = 0.0;  // in the tile
  glm::dvec2 edge_{0.0}, low_{1e300}, high_{-1e300};
  bool in_front_ = true, inside_ = true;
};

}  // namespace dmise
