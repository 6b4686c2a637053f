#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/fusion/fusion_settings.h"
#include "core/products/track.h"
#include "core/tracking/filter.h"

namespace dmise {

/// Magnitudes by which an object at this range is fainter than one 1000 km away.
double brightness_offset(double range_m);

/// The mean magnitude at 1000 km of what was detected of an object, where that has one.
struct MeanBrightness {
  double sum = 0.0;
  int count = 0;

  void add(double magnitude, double range_m);
  bool is_known() const { return count > 0; }
  /// As if at this range; if nothing was measured, that of an object that is bright.
  double magnitude(double range_m) const;
};

/// A track that has not ended.
struct LiveTrack {
  LiveTrack(std::uint32_t number, OrbitFilter&& start, std::optional<std::size_t> of_catalogue);

  std::uint32_t id;
  OrbitFilter filter;
  std::optional<std::size_t> object;  // index in the catalogue
  int min_detections = 0;             // that confirm it
  TrackStatus status = TrackStatus::tentative;
  double log_odds = 0.0;  // that it exists
  int detections = 0;
  SimTime last_seen;
  MeanBrightness brightness;
  double innovation_d2 = 0.0;
  std::vector<std::string> associated;  // since the last tick
  std::vector<std::string> seen_in;     // exposures that it took a detection of, the last ones
  bool changed = true;
  // Where orbits are kept: what was believed of a catalogued object, and the detections that no
  // kept orbit has yet.
  std::optional<OrbitEstimate> began_with = {};
  std::optional<std::vector<AngleObservation>> arc = {};

  // For a coarse search: the state at a common time, and its uncertainty.
  OrbitState rough;
  double sigma_m = 0.0, sigma_m_per_s = 0.0, age_s = 0.0;

  double existence() const;
  double magnitude(double range_m) const { return brightness.magnitude(range_m); }
  /// Propagates the state to a time as `rough`. False if it has no path.
  bool place_roughly(const ForceModel& forces, SimTime time);
  /// Bound of the error of `rough` [m], one sigma.
  double rough_sigma_m(double acceleration_noise_m2_per_s3) const;

  /// Counts a detection, and its brightness if the object is at `position_m`.
  void count(const AngleObservation& observation, double magnitude, const Vec<Gcrs>& position_m);
  /// Takes a detection into the orbit, and counts it. `false_per_sr` is the density of what else
  /// may have made it. False, and nothing changed, if the filter refuses it.
  bool take(const AngleObservation& observation, double magnitude, double detection_probability,
            double false_per_sr);
  /// Takes what a source that is the light of this object and another's tells of its orbit. It is
  /// no detection of this one. False, and nothing changed, if the filter refuses it.
  bool take_part(const AngleObservation& part);
  /// Whether it took a detection of the exposure that a detection is of.
  bool is_seen_beside(const std::string& detection_id) const;
  /// A look with this probability of detection found nothing.
  void miss(double detection_probability);
};

/// The state of a track at a tick as it is published.
Track published(const LiveTrack& track, SimTime time);

}  // namespace dmise
