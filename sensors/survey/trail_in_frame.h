#pragma once
#include <span>

#include "core/optics/camera.h"
#include "sensors/objects/object_sampler.h"

namespace dmise {

/// The part of an object's trail that is in the frame and lit.
struct TrailInFrame {
  double signal_e = 0.0;  // light that is in it
  double length_px = 0.0;
  PixelPosition centroid;  // weighted by the light; the frame's corner without any
};

/// `samples`: an odd number, at even times from the start to the end of an exposure of `seconds`;
/// between them places and light follow parabolas of three. The blur is neglected: light is in the
/// frame where its source is.
TrailInFrame trail_in_frame(std::span<const ObjectSample> samples, double seconds,
                            const Optics& optics);

}  // namespace dmise
