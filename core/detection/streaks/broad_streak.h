#pragma once
#include <optional>
#include <vector>

#include "core/detection/source/line_profile.h"

namespace dmise {

/// A line of light that is wider than the PSF, as of an object so near that it is out of focus.
struct BroadLine {
  Line line;
  Extent extent;
  double sigma_px = 0.0;    // Gaussian nearest to its profile across
  bool is_no_pair = false;  // the light between its sides is too much for two streaks
};

/// The broad line along a rough one through the points of a component; empty if its profile across
/// has no more than 1.3 times the PSF's width, or is faint in each pixel.
std::optional<BroadLine> broad_line(const Scene& scene, const std::vector<Point>& points,
                                    const Line& rough);

/// Relative error of a Gaussian as the profile of a broad line, which may be flat or hollow.
inline constexpr double broad_profile_error = 0.5;

}  // namespace dmise
