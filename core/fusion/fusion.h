#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/fusion/arc_start.h"
#include "core/fusion/blended_pair.h"
#include "core/fusion/catalogue_prediction.h"
#include "core/fusion/fusion_settings.h"
#include "core/fusion/kept_orbits.h"
#include "core/fusion/live_track.h"
#include "core/fusion/observation_plan.h"
#include "core/fusion/sensor_frame.h"
#include "core/fusion/track_start.h"
#include "core/orbit/elements/elements.h"
#include "core/products/found_breakup.h"
#include "core/products/track.h"
#include "core/time/clock.h"
#include "core/tracking/maintenance/pinch_search.h"

namespace dmise {

/// Result of one tick.
struct FusionTick {
  std::vector<Track> tracks;           // those that changed, by id
  std::uint32_t live = 0;              // tracks that have not ended
  std::uint32_t unassociated = 0;      // sources of the tick that no track took
  std::vector<KeptOrbit> orbits;       // kept orbits that an arc changed, by track
  std::vector<FoundBreakup> breakups;  // that these show
};

/// Tracks of objects from the frames of all sensors: global nearest neighbours with gates, one
/// assignment per frame over tracks and catalogued objects; orbits of what is in no catalogue begin
/// by triangulation from two sites or by the arc of one; square-root unscented filters.
/// docs/models/fusion.md says which and why.
///
/// The result of a tick depends on its frames, not on their order.
class Fusion {
 public:
  /// `reference`: the middle of the run, around which forces are tabulated.
  Fusion(std::vector<MeanElements> catalogue, const Clock& clock, SimTime reference,
         const FusionSettings& settings = {});
  Fusion(const Fusion&) = delete;  // filters refer to its forces
  Fusion& operator=(const Fusion&) = delete;

  /// Performs the work of one tick. Frames may be of earlier exposures than those of the tick
  /// before.
  FusionTick step(SimTime time, std::vector<SensorFrame> frames);

  /// The tracks that have not ended, by id, with their states at `time`: what a scheduler chooses
  /// among.
  std::vector<CueTarget> targets(SimTime time) const;

 private:
  struct Candidate;
  struct Scene;
  void associate(Scene& scene, const SensorFrame& frame, std::span<const std::uint64_t> inside);
  std::optional<BlendedPair> blend_of(const Candidate& a, const Candidate& b,
                                      const SensorFrame& frame, const AngleObservation& seen) const;
  /// Gives sources that are the light of two tracks to both, and marks these as found.
  void take_blends(const SensorFrame& frame, std::span<const Candidate> all,
                   std::vector<bool>& found, std::vector<bool>& blended);
  std::vector<Candidate> candidates(Scene& scene, const SensorFrame& frame,
                                    std::span<const std::uint64_t> inside) const;
  PredictedDirection predicted(const Candidate& candidate, const SensorFrame& frame,
                               const AngleObservation& observation) const;
  LiveTrack* begin_catalogued(std::size_t object, SimTime seen, bool burnt);
  void begin_unknown(const std::vector<LooseSource>& loose);
  void begin_from_arcs(const std::vector<LooseSource>& loose);
  void begin(const StartedOrbit& orbit, int min_detections);
  /// Whether an orbit is that of a track within both's errors, and not of another object beside it.
  bool is_known(const StartedOrbit& orbit) const;
  void take_rest(LiveTrack& track, const std::vector<LooseSource>& loose,
                 std::vector<std::string>& taken);
  void age(SimTime time);

  // fusion_keeping.cpp
  Outcome<OrbitEstimate> believed(std::size_t object, SimTime time) const;
  void keep_arcs(SimTime time, FusionTick& out);
  bool is_closed(const LiveTrack& track, SimTime time) const;
  std::optional<KeptOrbit> keep(LiveTrack& track);
  std::optional<std::size_t> owner_of(const LiveTrack& track, const OrbitState& seen);
  /// Looks for a point from which an object in no catalogue came together with others.
  std::optional<FoundBreakup> breakup_of(std::size_t object);
  /// Names the catalogued object that passed a point, if one did.
  void name_parent(const PinchPoint& point, FoundBreakup& breakup);
  void name_object(std::size_t object, std::uint32_t& catalogue_number, std::string& name) const;

  Clock clock_;
  FusionSettings settings_;
  ForceModel forces_;
  FilterSettings filter_;
  CataloguePrediction catalogue_;
  TrackStart start_;
  ArcStart arcs_;
  std::vector<std::unique_ptr<LiveTrack>> tracks_;  // by id
  std::vector<LiveTrack*> track_of_;                // for each object; null: none
  std::unique_ptr<KeptOrbits> kept_;                // null: none are kept
  // Objects beyond the catalogue, by the track with which each began.
  std::vector<std::uint32_t> new_objects_;
  std::unique_ptr<PinchSearch> pinches_;            // null as kept_
  std::vector<std::vector<std::size_t>> breakups_;  // members of those that are announced
  std::uint32_t next_id_ = 1;
};

}  // namespace dmise
