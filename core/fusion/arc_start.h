#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/fusion/fusion_settings.h"
#include "core/fusion/track_start.h"
#include "core/tracking/forces.h"

namespace dmise {

/// Begins orbits of what one site alone sees: sources of one sensor over several exposures that lie
/// on a smooth path, and whose arc determines a range. What two sites see begins sooner by
/// `TrackStart`.
class ArcStart {
 public:
  ArcStart(const ForceModel& forces, const FusionSettings& settings);

  /// The orbits whose arcs end in these sources; at most two are tried.
  std::vector<StartedOrbit> add(const std::vector<LooseSource>& sources);
  /// What has been taken is not to begin another track.
  void forget(const std::vector<std::string>& detection_ids);

 private:
  using Arc = std::vector<const LooseSource*>;  // by falling time
  std::vector<Arc> arcs_to(const LooseSource& last, const std::vector<LooseSource>& earlier) const;
  /// Nothing if the sources, by time, leave the range open or fit no orbit.
  std::optional<StartedOrbit> orbit_of(const std::vector<LooseSource>& arc) const;

  const ForceModel& forces_;
  FusionSettings settings_;
  std::map<std::string, std::vector<LooseSource>> loose_;  // of each sensor, by time
};

}  // namespace dmise
