#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/forces/forces.h"
#include "core/frames/earth_orientation.h"
#include "core/fusion/cued_sensor.h"
#include "core/fusion/mount.h"
#include "core/products/task.h"
#include "core/sky/bodies/shadow.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/clock.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// A track among which a scheduler chooses.
struct CueTarget {
  std::uint32_t track = 0;             // its id
  std::uint32_t catalogue_number = 0;  // 0: in no catalogue
  std::string name;
  double existence = 1.0;  // probability
  double magnitude = 0.0;  // as if 1000 km away
  OrbitEstimate estimate;
};

/// A track that a sensor is to observe, as a tracker wishes.
struct CueWish {
  std::string sensor;
  std::uint32_t track = 0;
  std::uint32_t exposures = 0;  // most of the task; 0: as many as the sensor's settings say
  std::string_view obstacle{};  // why there is no task: "it is busy"; a scheduler sets it

  bool operator==(const CueWish&) const = default;
};

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The Earth, Sun, Moon and the Earth's shadow over the next minutes.
struct CueSky {
  CueSky(const Clock& clock, SimTime time, const Ellipsoid& ellipsoid = wgs84);

  EarthOrientation earth;
  SolarSystem bodies;
  EarthShadow shadow;
};

/// Exposures of a target by a sensor. Information is about the position and velocity of the
/// target at a common epoch.
struct ObservationPlan {
  SimTime start, on_target, end;
  std::uint32_t first_frame = 0, exposures = 0;
  double slew_rad = 0.0, slew_s = 0.0;
  double in_field = 0.0, detection_probability = 0.0, sigma_rad = 0.0;
  Matrix6 information = Matrix6::Zero();  // if all exposures detect it
  OrbitEstimate at;                       // on_target
  MountPosition at_end;

  double seconds() const { return (end - start).seconds(); }
};

/// Plans exposures of a target by a sensor whose mount stands at `from` until `start`. Refuses
/// one that can't be observed: out of reach of the mount, in the shadow, near the Sun or the Moon,
/// faster than the mount, or after `last`.
Outcome<ObservationPlan> plan_observation(const ForceModel& forces, const CueSky& sky,
                                          const CuedSensor& sensor, const CueTarget& target,
                                          const MountPosition& from, SimTime start, SimTime last,
                                          double best_detection_probability);

/// Estimates the rate at which a plan would gain information [nats/s], by two-body motion and one
/// exposure, so that few targets need a plan. 0 below the horizon.
double rough_rate(const CueSky& sky, const CuedSensor& sensor, const CueTarget& target,
                  const MountPosition& from, SimTime start);

/// The information of exposures that a task has, about the target at the epoch of `estimate`,
/// times their probability of detection. Zero if the path can't be integrated.
Matrix6 information_of(const ForceModel& forces, const CueSky& sky, const CuedSensor& sensor,
                       const Task& task, const OrbitEstimate& estimate);

/// Half the logarithm of the determinant by which `added` shrinks the covariance of a target of
/// which `known` will be known [nats].
double gain_nats(const OrbitEstimate& estimate, const Matrix6& known, const Matrix6& added);

/// Puts the states from `from` to `to` or later into the path of a task; less if it enters the
/// Earth.
void put_path(const ForceModel& forces, const OrbitState& state, SimTime from, SimTime to,
              Task& task);

}  // namespace dmise
