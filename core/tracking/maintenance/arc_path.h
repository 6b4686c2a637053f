#pragma once
#include <span>
#include <vector>

#include "core/forces/numerical_flight.h"
#include "core/tracking/maintenance/maintenance_forces.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// A change of velocity at once along radius, motion and normal [m/s].
struct VelocityChange {
  SimTime time;
  Vec<Rtn> delta_v_m_per_s;
};

/// The path of one object from a start on, or back from there, with the derivatives of its states
/// by those at the start.
class ArcPath {
 public:
  /// Refuses a state that is not sane and a path that ends before `to`. `changes` in order of time,
  /// none at or before the start. A path to an earlier time has none. `forces` must live as long.
  static Outcome<ArcPath> fly(const MaintenanceForces& forces, const OrbitState& start,
                              std::span<const VelocityChange> changes, SimTime to);

  SimTime start() const { return start_.time; }
  SimTime end() const { return end_; }
  /// Between start and end.
  OrbitState at(SimTime time) const;
  /// d state(time) / d state(start).
  OrbitMatrix transition(SimTime time) const;

 private:
  ArcPath(const MaintenanceForces& forces, const OrbitState& start, SimTime end,
          std::vector<OemSegment> segments);
  std::string_view chain();

  const MaintenanceForces* forces_;
  OrbitState start_;
  SimTime end_;
  Trajectory path_;
  std::vector<OrbitState> states_;        // every step_ns
  std::vector<OrbitMatrix> transitions_;  // to them
};

}  // namespace dmise
