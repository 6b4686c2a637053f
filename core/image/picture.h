#pragma once
#include "core/base/image.h"

namespace dmise {

/// How counts become grey: asinh from just below the sky, so that noise and faint stars show and
/// bright ones keep their shape. Accuracy knobs of a picture for people, not of a measurement.
struct PictureSettings {
  int max_width = 1663;        // larger frames are averaged over squares of pixels
  int min_width = 640;         // smaller ones are drawn with larger pixels
  double black_sigma = 2.5;    // of the sky's noise, below the median
  double white_sigma = 250.0;  // above it
  double white_share = 0.005;  // of the pixels may be beyond; more stretch the scale
  double linear_sigma = 4.0;   // where asinh turns from linear to logarithmic
};

/// A picture and where frame pixels are in it.
struct Preview {
  Picture picture;
  double pixels_per_px = 1.0;  // picture pixels along one frame pixel

  /// Picture coordinates of a frame coordinate (both: centre of the first pixel is 0).
  double place(double frame_px) const { return (frame_px + 0.5) * pixels_per_px - 0.5; }
};

/// Grey, one channel. A frame of equal counts comes out evenly dark.
Preview preview(const CountImage& counts, const PictureSettings& settings = {});

}  // namespace dmise
