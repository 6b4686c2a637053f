#include "core/materials/polygon.h"

#include <cmath>
#include <numeric>

namespace dmise {
namespace {

struct Point {
  double x, y;
};

double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool same(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

/// Projects the corners on the coordinate plane closest to the face's plane, counter-clockwise.
std::vector<Point> flattened(const std::vector<Vec<Body>>& corners) {
  Vec<Body> normal;  // Newell's method: valid for faces that are not quite flat
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += cross(corners[i], corners[(i + 1) % corners.size()]);
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  std::vector<Point> flat;
  for (const auto& c : corners) {
    if (z >= x && z >= y)
      flat.push_back({normal.z < 0 ? -c.x : c.x, c.y});
    else if (y >= x)
      flat.push_back({normal.y < 0 ? -c.z : c.z, c.x});
    else
      flat.push_back({normal.x < 0 ? -c.y : c.y, c.z});
  }
  return flat;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vec<Body>>& corners) {
  const auto points = flattened(corners);
  std::vector<std::uint32_t> left(corners.size());
  std::iota(left.begin(), left.end(), 0u);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = left.size();
    const Point &a = points[left[(i + n - 1) % n]], &b = points[left[i]],
                &c = points[left[(i + 1) % n]];
    if (!(turn(a, b, c) > 0)) return false;
    for (std::size_t k = 2; k + 1 < n; ++k) {
      const Point& p = points[left[(i + k) % n]];
      if (same(p, a) || same(p, b) || same(p, c)) continue;  // seam to a hole
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  };
  while (left.size() > 3) {
    std::size_t ear = 0;
    while (ear < left.size() && !is_ear(ear)) ++ear;
    if (ear == left.size()) break;
    const std::size_t n = left.size();
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + std::ptrdiff_t(ear));
  }
  for (std::size_t i = 1; i + 1 < left.size(); ++i)
    triangles.push_back({left[0], left[i], left[i + 1]});
  return triangles;
}

}  // namespace dmise
