#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/fusion/arc_start.h"
#include "core/fusion/catalogue_prediction.h"
#include "core/fusion/fusion.h"
#include "core/fusion/live_track.h"
#include "core/fusion/sensor_frame.h"
#include "core/fusion/track_start.h"

namespace dmise {

/// What is behind a `Fusion`.
class FusionBody {
 public:
  FusionBody(std::vector<MeanElements> catalogue, const Clock& clock, SimTime reference,
             const FusionSettings& settings);
  FusionBody(const FusionBody&) = delete;  // filters refer to its forces
  FusionBody& operator=(const FusionBody&) = delete;

  FusionTick step(SimTime time, std::vector<SensorFrame> frames);

  std::vector<CueTarget> targets(SimTime time) const;
  const std::vector<std::unique_ptr<LiveTrack>>& tracks() const { return tracks_; }

 private:
  struct Candidate;
  struct Scene;
  void associate(Scene& scene, const SensorFrame& frame, std::span<const std::uint64_t> inside);
  std::vector<Candidate> candidates(Scene& scene, const SensorFrame& frame,
                                    std::span<const std::uint64_t> inside) const;
  PredictedDirection predicted(const Candidate& candidate, const SensorFrame& frame,
                               const AngleObservation& observation) const;
  LiveTrack* begin_catalogued(std::size_t object, SimTime seen);
  void begin_unknown(const std::vector<LooseSource>& loose);
  void begin_from_arcs(const std::vector<LooseSource>& loose);
  void begin(const StartedOrbit& orbit, int least_detections);
  bool is_known(const OrbitEstimate& estimate) const;
  void take_rest(LiveTrack& track, const std::vector<LooseSource>& loose,
                 std::vector<std::string>& taken);
  void age(SimTime time);

  Clock clock_;
  FusionSettings settings_;
  ForceModel forces_;
  FilterSettings filter_;
  CataloguePrediction catalogue_;
  TrackStart start_;
  ArcStart arcs_;
  std::vector<std::unique_ptr<LiveTrack>> tracks_;  // by id
  std::vector<LiveTrack*> track_of_;                // of each catalogued object, null: none
  std::uint32_t next_id_ = 1;
};

}  // namespace dmise
