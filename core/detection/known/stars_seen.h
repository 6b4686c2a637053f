#pragma once
#include "core/base/pixel.h"

namespace dmise {

/// How a frame agrees with a catalogue of stars at the header's pointing.
struct StarsSeen {
  int expected = 0, found = 0;  // stars that are well above the noise
  PixelPosition shift;          // from where stars are expected to where they are
  double scatter_px = 0.3;      // about it, along one axis

  /// Whether the frame shows the stars, so that the catalogue's places and gaps can be relied on.
  bool agree() const { return found >= 1 && 10 * found >= 3 * expected; }
};

}  // namespace dmise
