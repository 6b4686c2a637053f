#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/fusion/fusion_settings.h"
#include "core/fusion/sensor_frame.h"
#include "core/tracking/batch.h"
#include "core/tracking/initial/triangulate.h"

namespace dmise {

/// A detection that no track took.
struct LooseSource {
  SeenSource source;
  double false_per_sr = 0.0;  // false alarms in its frame
  std::uint32_t frame = 0;    // counted by its sensor
};

inline const AngleObservation& seen(const LooseSource& s) { return s.source.observation; }

/// An orbit from two places, each seen by two sites.
struct StartedOrbit {
  BatchFit fit;
  std::vector<LooseSource> sources;  // by time
};

/// Begins orbits of what is in no catalogue. Two sites that see something at one time give a place
/// where their lines of sight meet; two places within the window that a bound orbit joins, and that
/// all four lines fit, give an orbit.
class TrackStart {
 public:
  TrackStart(const ForceModel& forces, const FusionSettings& settings);

  /// The orbits that end in these sources, the best fit first; no source is in two.
  std::vector<StartedOrbit> add(const std::vector<LooseSource>& sources);
  /// Removes sources that a track has taken.
  void forget(const std::vector<std::string>& detection_ids);
  /// Loose sources of the window, by time.
  const std::vector<LooseSource>& loose() const { return loose_; }

 private:
  struct Place {
    TriangulatedPosition where;
    double sigma_m = 0.0;
    LooseSource a, b;
  };
  std::optional<Place> meet(const LooseSource& a, const LooseSource& b) const;
  bool may_be_one(const Place& from, const Place& to) const;

  const ForceModel& forces_;
  FusionSettings settings_;
  std::vector<LooseSource> loose_;
  std::vector<Place> places_;
};

}  // namespace dmise
