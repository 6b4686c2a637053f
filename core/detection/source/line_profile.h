#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/detection/source/scene.h"

// Light along a line in slices.
namespace dmise {

struct Point {
  double x, y;
  double weight = 1.0;  // by brightness, to follow the ridge
};

/// A line divided into slices: one per column (or row, if it is steeper than 45 degrees). It may be
/// curved as a trail is, and extends beyond the trail's ends.
struct Line {
  double x = 0.0, y = 0.0;  // a point on it
  double ux = 1.0, uy = 0.0;
  double sagitta_px = 0.0, half_length_px = 1.0;

  bool by_columns() const { return std::abs(ux) >= std::abs(uy); }
  double major(const Point& p) const { return by_columns() ? p.x : p.y; }
  /// Length of the line in one slice.
  double slice_px() const { return 1.0 / std::max(std::abs(ux), std::abs(uy)); }
  double off(const Point& p) const { return (p.y - y) * ux - (p.x - x) * uy; }
  /// Point of the slice, `offset_px` across from the line.
  Point at(double major_px, double offset_px = 0.0) const {
    const double along = by_columns() ? (major_px - x) / ux : (major_px - y) / uy;
    const double r = along / half_length_px;
    const double off_px = offset_px + sagitta_px * (1.0 / 3 - r * r);
    return by_columns() ? Point{major_px, y + along * uy + off_px / ux}
                        : Point{x + along * ux - off_px / uy, major_px};
  }
};

/// Line through a trail, with its curvature.
inline Line line_of(const Trail& t) {
  return {t.x_px,
          t.y_px,
          std::cos(t.angle_rad),
          std::sin(t.angle_rad),
          t.sagitta_px,
          std::max(t.length_px / 2, 1.0)};
}

/// Principal axis of the points within `width_px` of a line; the line if there are none.
Line principal_axis(const std::vector<Point>& points, const Line& line, double width_px);

/// Extent of a streak along its line's major axis.
struct Extent {
  int from, to;
};

inline Extent extent_of(const Line& line, double half_length_px) {
  constexpr double most = 1e8;  // far outside of any frame
  const double centre = line.by_columns() ? line.x : line.y;
  const double half = half_length_px / line.slice_px();
  return {int(std::lround(std::clamp(centre - half, -most, most))),
          int(std::lround(std::clamp(centre + half, -most, most)))};
}

/// The part of an extent that is in the frame; empty, with `to` before `from`, if none is.
inline Extent in_frame(const Scene& scene, const Line& line, const Extent& extent) {
  const int size = line.by_columns() ? scene.counts.columns : scene.counts.rows;
  return {std::max(extent.from, 0), std::min(extent.to, size - 1)};
}

/// Electrons per px of length in one slice, by the matched profile across.
struct Slice {
  double e_per_px = 0.0, variance = 0.0;  // variance 0: no valid pixel
};

Slice slice_at(const Scene& scene, const Line& line, int major, double offset_px);

/// Slices `from` to `to`, without those that have no valid pixel.
std::vector<Slice> slices(const Scene& scene, const Line& line, int from, int to, double offset_px);

double median_level(const std::vector<Slice>& s);

/// Returns the mean with values clipped at twice `level`, as of a star on the line, and its SNR.
std::array<double, 2> clipped_mean(const std::vector<Slice>& s, double level);

/// Returns the most significant gap within an extent in which a line of `level` has no light, if it
/// is longer than the PSF and not made by noise.
std::optional<Extent> dark_gap(const Scene& scene, const Line& line, const Extent& extent,
                               double level, double offset_px = 0.0);

/// A trail along the line over the extent.
Trail trail_along(const Line& line, const Extent& extent, double level);

/// Light of a line: the mean of its slices, none of which counts for much more than the streak's,
/// or their median, to which a few stars add nothing.
enum class LineLight { mean, median };

/// Returns the excess of a trail's light over parallel lines beside it, in units of their scatter,
/// which exceeds the pixels' noise where faint stars are dense. Infinite if there are too few
/// lines.
double rise_above_neighbours(const Scene& scene, const Trail& trail,
                             LineLight by = LineLight::mean);

}  // namespace dmise
