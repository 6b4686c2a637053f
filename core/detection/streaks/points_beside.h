#pragma once
#include <array>
#include <vector>

#include "core/detection/source/scene.h"

namespace dmise {

/// Two points as which some pixels are fitted.
struct TwoPoints {
  std::array<Trail, 2> points;
  TrailFit fit;
};

/// Fits pixels as two points of any light. `light`: the uniform trail of the same light and spread,
/// along which they begin.
TwoPoints fit_as_two_points(const std::vector<FitPixel>& pixels, const Trail& light,
                            const FitSettings& settings);

/// The final fit of two points that blend: both at once, over all pixels near them, with the
/// covariance of both. Empty if it fails, if one is too faint, or if they are so near that the
/// light of each is lost in the errors.
std::vector<Source> points_beside(const Scene& scene, const std::array<Trail, 2>& start);

}  // namespace dmise
