#pragma once
#include <span>
#include <vector>

#include "core/fusion/observation_plan.h"

namespace dmise {

/// Chooses what narrow-field sensors observe. When a sensor is free it takes, of the tracks that it
/// can see, the one that is expected to tell most in the time that it takes: half the logarithm of
/// the determinant by which its exposures shrink the covariance, times the probabilities that the
/// object exists, lies in the field and is detected, over the time to slew, settle and expose.
/// What other sensors have been told to observe counts as known. Among several free sensors the one
/// with the best choice goes first. Ties go to the name, and to the lower id.
///
/// The result depends on times and targets alone: the same calls give the same tasks.
class Scheduler {
 public:
  /// `reference`: a time of the run, around which forces are tabulated; `last`: its end.
  Scheduler(const Clock& clock, SimTime reference, std::vector<CuedSensor> sensors, SimTime last,
            double best_detection_probability);

  /// Returns whether a sensor is free before `next`, the earliest start of a task of the next call;
  /// `begin`: that of this one.
  bool is_asked(SimTime begin, SimTime next) const;

  /// Tasks that begin at `begin` or later, before `next`, by id. `now`: the time of the tick.
  /// With `wishes`, at most one for a sensor, tasks are those alone, whatever they gain; a wish
  /// without a task has its obstacle set.
  std::vector<Task> step(SimTime now, SimTime begin, SimTime next,
                         std::span<const CueTarget> targets,
                         std::vector<CueWish>* wishes = nullptr);

 private:
  struct Mount {
    CuedSensor sensor;
    MountPosition position;  // where it stands
    SimTime free;            // from then on
  };
  struct Option {
    const CueTarget* target = nullptr;
    ObservationPlan plan;
    double gain_nats = 0.0;
    double rate() const { return gain_nats / plan.seconds(); }
  };
  std::vector<Option> options(const CueSky& sky, const Mount& mount, SimTime start,
                              std::span<const CueTarget> targets) const;
  /// The one that is wished; else sets the obstacle.
  std::vector<Option> wished(const CueSky& sky, const Mount& mount, SimTime start,
                             std::span<const CueTarget> targets, CueWish& wish) const;
  void weigh(const CueSky& sky, std::vector<Option>& options, std::uint32_t of_track) const;
  Matrix6 known_of(const CueSky& sky, const CueTarget& target) const;
  Task task_of(const Mount& mount, const std::vector<Option>& options, SimTime now);

  Clock clock_;
  ForceModel forces_;
  std::vector<Mount> mounts_;  // by name
  SimTime last_;
  double best_detection_probability_;
  std::vector<Task> pending_;  // whose detections are not known yet
  std::uint32_t next_id_ = 1;
};

}  // namespace dmise
