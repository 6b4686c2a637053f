#pragma once
#include "core/base/image.h"

namespace dmise {

/// Conversion of counts to grey: asinh from just below the sky, which shows noise and faint stars
/// and keeps the shape of bright ones. For display only.
struct PictureSettings {
  int max_width = 1663;        // larger frames are averaged over squares of pixels
  int min_width = 640;         // smaller ones are drawn with larger pixels
  double black_sigma = 2.5;    // of the sky's noise, below the median
  double white_sigma = 250.0;  // above it
  double white_share = 0.005;  // maximum fraction of pixels above white
  double linear_sigma = 4.0;   // where asinh turns from linear to logarithmic
};

/// A picture and its mapping from frame coordinates.
struct Preview {
  Picture picture;
  double pixels_per_px = 1.0;  // picture pixels along one frame pixel

  /// Picture coordinates of a frame coordinate (both: centre of the first pixel is 0).
  double place(double frame_px) const { return (frame_px + 0.5) * pixels_per_px - 0.5; }
};

/// Grey picture, one channel. A frame of equal counts is uniformly dark.
Preview preview(const CountImage& counts, const PictureSettings& settings = {});

}  // namespace dmise
