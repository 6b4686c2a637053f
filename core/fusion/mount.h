#pragma once
#include <optional>
#include <vector>

#include "core/base/sim_time.h"
#include "core/frames/geodesy.h"
#include "core/fusion/cue_settings.h"

namespace dmise {

/// Where a mount points, and how its azimuth axis stands: with whole turns, for cables wind up.
struct MountPosition {
  Vec<Enu> direction;
  double azimuth_rad = 0.0;  // from north through east; of an altazimuth mount alone
};

MountPosition mount_position(double azimuth_deg, double elevation_deg);

/// Time of a turn from rest to rest [s], without settling: at an acceleration (0: at once) up to a
/// speed, and down.
double turn_s(double angle_rad, double deg_per_s, double deg_per_s2);

/// A turn of the mount, without settling.
struct Slew {
  double angle_rad = 0.0;  // along the great circle, or of the axis that turns farther
  double seconds = 0.0;
  MountPosition to;
};

/// The ways to a direction within the limits of the axes, the fastest first: one along the great
/// circle, or one for each turn of the azimuth axis that its range allows.
std::vector<Slew> slews_to(const CueSettings& cue, const MountPosition& from,
                           const Vec<Enu>& direction);

/// Where a mount stands that has followed from one direction to another in `seconds`. Nothing if an
/// axis is too slow (near the zenith the azimuth turns fastest) or at its limit.
std::optional<MountPosition> followed(const CueSettings& cue, const MountPosition& from,
                                      const Vec<Enu>& direction, double seconds);

}  // namespace dmise
