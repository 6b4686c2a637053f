#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/base/pixel.h"

namespace dmise {

/// A place in an image with its error.
struct MeasuredPlace {
  PixelPosition place;                     // (0, 0) is the centre of the first pixel
  std::array<double, 3> covariance_px2{};  // var x, cov xy, var y
};

/// A source that another detector than ours found in a frame.
struct MeasuredSource {
  MeasuredPlace centroid;
  std::optional<std::array<MeasuredPlace, 2>> ends;  // only streaks have them
  double light_e = 0.0;                              // above the background
  double snr = 0.0;                                  // light_e / its standard error
};

inline constexpr std::size_t max_measured_sources = 100'000;  // in a frame
inline constexpr double max_outside_px = 16.0;                // from the frame's edge to a place
inline constexpr double max_sigma_px = 10'000.0;

/// Throws `Error` "found[3].x_px: must be finite, got nan" for sources that can't be of a frame of
/// this size.
void check_sources(const std::vector<MeasuredSource>& sources, int columns, int rows);

}  // namespace dmise
