#pragma once
#include <vector>

#include "core/sequences/track_fit.h"

namespace dmise {

/// A point that moves or flashes, in one frame.
struct MovingPoint {
  PixelPosition place;      // in the frame
  PixelPosition reference;  // where the reference frame has the same sky
  double snr = 0.0;
};

/// Local maxima above an SNR of 5, by falling SNR, at most 400.
std::vector<MovingPoint> find_moving_points(const MovingLight& light,
                                            const Registration& registration, std::size_t frame);

/// Motions on which points of several frames lie, by falling number of them: at least three, and
/// two fifths of the frames. Each has other points than those before it.
std::vector<SkyMotion> link_points(const TrackScene& scene);

}  // namespace dmise
