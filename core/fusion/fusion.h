#pragma once
#include <memory>
#include <vector>

#include "core/fusion/fusion_settings.h"
#include "core/fusion/observation_plan.h"
#include "core/fusion/sensor_frame.h"
#include "core/orbit/elements.h"
#include "core/products/track.h"
#include "core/time/clock.h"

namespace dmise {

/// What a fusion tells of one tick.
struct FusionTick {
  std::vector<Track> tracks;       // that changed, by id
  std::uint32_t live = 0;          // tracks that have not ended
  std::uint32_t unassociated = 0;  // sources of the tick that no track took
};

class FusionBody;

/// Tracks of objects from the frames of all sensors: global nearest neighbours with gates, one
/// assignment per frame over tracks and catalogued objects; orbits of what is in no catalogue begin
/// by triangulation; square-root unscented filters. docs/models/fusion.md says which and why.
///
/// The result of a tick depends on its frames, not on their order.
class Fusion {
 public:
  /// `reference`: a time of the run, around which forces are tabulated.
  Fusion(std::vector<MeanElements> catalogue, const Clock& clock, SimTime reference,
         const FusionSettings& settings = {});
  ~Fusion();

  /// The work of one tick. Frames may be of earlier exposures than those of the tick before.
  FusionTick step(SimTime time, std::vector<SensorFrame> frames);

  /// The tracks that have not ended, by id, with their states at `time`: what a scheduler chooses
  /// among.
  std::vector<CueTarget> targets(SimTime time) const;

  /// Probabilities of existence of the tracks that have not ended, by id.
  std::vector<double> existences() const;

 private:
  std::unique_ptr<FusionBody> body_;
};

}  // namespace dmise
