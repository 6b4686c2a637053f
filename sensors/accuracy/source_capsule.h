#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/pixel.h"
#include "sensors/accuracy/frame_error.h"

// Capsules around the trails of sources, in which their light is measured.
namespace dmise {

/// A line along a trail that is `from`, `via` and `to` at its start, middle and end: chords of the
/// parabola through them, 0.05 px off it at most. At least two points.
std::vector<PixelPosition> line_along(PixelPosition from, PixelPosition via, PixelPosition to);

/// From the line of a source's trail.
double distance_px(PixelPosition p, const ReferenceSource& s);

/// Calls `visit(pixel index, x, y)` for the pixels of a capsule; false: it reaches out of the
/// frame.
template <class Visit>
bool for_capsule(const ReferenceSource& s, int columns, int rows, Visit&& visit) {
  double x0 = s.trail[0].x_px, x1 = x0, y0 = s.trail[0].y_px, y1 = y0;
  for (const PixelPosition p : s.trail) {
    x0 = std::min(x0, p.x_px);
    x1 = std::max(x1, p.x_px);
    y0 = std::min(y0, p.y_px);
    y1 = std::max(y1, p.y_px);
  }
  x0 -= s.margin_px, x1 += s.margin_px, y0 -= s.margin_px, y1 += s.margin_px;
  // Trails may end far beside the frame.
  const int first_x = int(std::clamp(x0, 0.0, double(columns)));
  const int first_y = int(std::clamp(y0, 0.0, double(rows)));
  const int last_x = int(std::ceil(std::clamp(x1, -1.0, columns - 1.0)));
  const int last_y = int(std::ceil(std::clamp(y1, -1.0, rows - 1.0)));
  for (int y = first_y; y <= last_y; ++y)
    for (int x = first_x; x <= last_x; ++x)
      if (distance_px({double(x), double(y)}, s) <= s.margin_px)
        visit(std::size_t(y) * std::size_t(columns) + std::size_t(x), x, y);
  return x0 >= 0.0 && y0 >= 0.0 && x1 <= columns - 1.0 && y1 <= rows - 1.0;
}

}  // namespace dmise
