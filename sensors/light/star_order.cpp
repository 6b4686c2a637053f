#include "sensors/light/star_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/optics/projection.h"

namespace dmise {
namespace {

/// On the sphere's stereographic plane about the boresight: tangents of half the angle from it.
struct PlanePlace {
  double x, y;
};

PlanePlace on_plane(const Vec<CameraFrame>& v) {
  const double stretch = 1.0 / std::max(1e-3, 1.0 + v.z);
  return {v.x * stretch, v.y * stretch};
}

/// The part of the plane that holds a frame.
struct PlaneBox {
  static constexpr double widest = 2.0;  // 127 deg from the boresight
  double left = -widest, right = widest, top = -widest, bottom = widest;
  bool is_whole_sky = true;

  PlaneBox(const Optics& o, double beside_rad) {
    constexpr int steps = 32;  // along each side
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double low_x = infinity, high_x = -infinity, low_y = infinity, high_y = -infinity;
    for (int i = 0; i <= steps; ++i) {
      const double x = -0.5 + double(i) / steps * o.columns, y = -0.5 + double(i) / steps * o.rows;
      for (const PixelPosition rim : {PixelPosition{x, -0.5}, PixelPosition{x, o.rows - 0.5},
                                      PixelPosition{-0.5, y}, PixelPosition{o.columns - 0.5, y}}) {
        const auto direction = unproject(o, rim);
        if (!direction) return;
        const PlanePlace at = on_plane(*direction);
        low_x = std::min(low_x, at.x), high_x = std::max(high_x, at.x);
        low_y = std::min(low_y, at.y), high_y = std::max(high_y, at.y);
      }
    }
    const double farthest = std::hypot(std::max(-low_x, high_x), std::max(-low_y, high_y));
    if (!(farthest < 0.8 * widest)) return;  // 116 deg
    // An angle is at most that much longer on the plane; sides are curved between the steps.
    const double reach = farthest + beside_rad;
    const double margin = 0.5 * beside_rad * (1.0 + reach * reach) + 0.01 * farthest;
    left = low_x - margin, right = high_x + margin;
    top = low_y - margin, bottom = high_y + margin;
    is_whole_sky = false;
  }
  bool holds(PlanePlace p) const {
    return is_whole_sky || (p.x >= left && p.x <= right && p.y >= top && p.y <= bottom);
  }
};

}  // namespace

void order_for_drawing(std::vector<std::uint32_t>& stars, const Column<Vec<Gcrs>>& direction,
                       const Rotation<CameraFrame, Gcrs>& camera, const Optics& optics,
                       double beside_rad) {
  constexpr std::size_t tiles = 96, block = 4;  // along each side
  constexpr std::size_t group = 16;
  const PlaneBox box(optics, beside_rad);
  const auto tile = [&](PlanePlace at) {
    const auto along = [&](double x, double low, double high) {
      return std::size_t(std::clamp((x - low) / (high - low) * tiles, 0.0, tiles - 1.0));
    };
    const std::size_t x = along(at.x, box.left, box.right), y = along(at.y, box.top, box.bottom);
    return ((y / block * (tiles / block) + x / block) * block + y % block) * block + x % block;
  };
  std::vector<std::uint32_t> first(tiles * tiles + 1, 0);
  std::vector<std::uint16_t> of;  // tile of each group
  std::size_t kept = 0;
  for (const std::uint32_t star : stars) {
    const PlanePlace at = on_plane(camera * direction[star]);
    if (!box.holds(at)) continue;
    if (kept % group == 0) ++first[of.emplace_back(std::uint16_t(tile(at))) + std::size_t(1)];
    stars[kept++] = star;
  }
  stars.resize(kept);
  for (std::size_t t = 1; t < first.size(); ++t) first[t] += first[t - 1];
  std::vector<std::uint32_t> order(of.size());
  for (std::size_t g = 0; g < of.size(); ++g) order[first[of[g]]++] = std::uint32_t(g);
  std::vector<std::uint32_t> sorted;
  sorted.reserve(kept);
  for (const std::size_t g : order)
    for (std::size_t i = g * group; i < std::min(kept, (g + 1) * group); ++i)
      sorted.push_back(stars[i]);
  stars = std::move(sorted);
}

}  // namespace dmise
