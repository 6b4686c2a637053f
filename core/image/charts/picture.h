#pragma once
#include "core/base/image.h"

namespace dmise {

/// A picture and its mapping from frame coordinates.
struct Preview {
  Picture picture;
  double pixels_per_px = 1.0;  // picture pixels along one frame pixel

  /// Picture coordinates of a frame coordinate (both: centre of the first pixel is 0).
  double place(double frame_px) const { return (frame_px + 0.5) * pixels_per_px - 0.5; }
};

/// Returns a grey picture of one channel, for display only: asinh of the counts from just below the
/// sky, which shows noise and faint stars and keeps the shape of bright ones. Wider frames are
/// averaged over squares of pixels. A frame of equal counts is uniformly dark.
Preview preview(const CountImage& counts, int max_columns = 1663);

}  // namespace dmise
