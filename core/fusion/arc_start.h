#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/forces/forces.h"
#include "core/fusion/fusion_settings.h"
#include "core/fusion/track_start.h"

namespace dmise {

/// Begins orbits from one site: sources of one sensor in several exposures that lie on a smooth
/// path whose curvature determines the range. From two sites `TrackStart` begins them sooner.
class ArcStart {
 public:
  ArcStart(const ForceModel& forces, const FusionSettings& settings);

  /// The orbits whose arcs end in these sources; at most two are tried.
  std::vector<StartedOrbit> add(const std::vector<LooseSource>& sources);
  /// Removes sources that a track has taken.
  void forget(const std::vector<std::string>& detection_ids);

 private:
  using Arc = std::vector<const LooseSource*>;  // by falling time
  std::vector<Arc> arcs_to(const LooseSource& last, const std::vector<LooseSource>& earlier) const;
  /// Nothing if the sources, by time, leave the range open or fit no orbit.
  std::optional<StartedOrbit> orbit_of(const std::vector<LooseSource>& arc) const;

  const ForceModel& forces_;
  FusionSettings settings_;
  std::map<std::string, std::vector<LooseSource>> loose_;  // by sensor, each by time
};

}  // namespace dmise
