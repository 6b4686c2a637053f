#pragma once
#include <vector>

#include "core/config/objects/named_motion.h"
#include "core/orbit/oem.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/time/clock.h"

namespace dmise {

/// Motion of an object as its scenario states it: element sets by SGP4, or another model.
class StatedMotion {
 public:
  using Model = StatedModel;

  /// `model` and `clock` must live as long as this.
  StatedMotion(const Model& model, const Clock& clock);

  /// State at a simulation time. Throws `Error` if there is none.
  FramedState at(double time_s) const;

  /// Segments in simulation time, up to `to_s`: those of a trajectory, or states from `from_s` on
  /// at steps of a twentieth of a radian and less. Throws `Error` if there is no state.
  std::vector<OemSegment> until(double from_s, double to_s) const;

 private:
  std::vector<OemSegment> shortened(const Trajectory& trajectory, double to_s) const;

  const Model& model_;
  const Clock& clock_;
  Sgp4Batch batch_;
};

/// Seconds from the start of the run to `time`.
double since_start_s(const Clock& clock, const Tai& time);

/// A state whose frame stands elsewhere.
MotionState<OemAxes> without_frame(const FramedState& state);

}  // namespace dmise
