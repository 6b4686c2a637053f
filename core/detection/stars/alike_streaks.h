#pragma once
#include <optional>
#include <span>
#include <utility>

#include "core/base/pixel.h"
#include "core/detection/source/scene.h"
#include "core/detection/stars/alike_trail.h"

namespace dmise {

/// What a fitted streak says of its motion: errors are along and across it.
struct StreakMotion {
  PixelPosition middle;
  double length_px = 0.0, angle_rad = 0.0;
  double along_px2 = 0.0, across_px2 = 0.0;       // variances of its ends' difference
  std::optional<std::pair<double, double>> bend;  // sagitta and its variance
};

/// Motion of a trail by the variances of its length and of its angle, to which the error of a
/// star's trail that is not its own is added. Empty if it says little of a star's motion.
std::optional<StreakMotion> streak_motion(const Trail& trail, double length_px2, double angle_rad2);

/// The streaks that agree in length, direction and bend to their errors, if they are more than
/// chance makes of so many. Empty if they lie in a row, as satellites of a train do, or are fewer
/// than three.
std::optional<AlikeStreaks> alike_motions(std::span<const StreakMotion> streaks);

/// Those of fitted sources.
std::optional<AlikeStreaks> alike_streaks(std::span<const Source> sources);

}  // namespace dmise
