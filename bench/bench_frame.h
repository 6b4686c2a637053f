#pragma once

namespace dmise {

/// Stages of a frame on one thread: star trails, streaks, optics by transforms, the detector.
int bench_frame(bool json);

}  // namespace dmise
