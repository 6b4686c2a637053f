#pragma once
#include <memory>

#include <Eigen/Core>

#include "core/forces/flight_forces.h"
#include "core/forces/forces.h"
#include "core/time/clock.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// What the forces of an orbit leave out, as white noise of the acceleration. Shares of drag and
/// sunlight are taken as unknown for a time, since the air and the attitude change within it.
struct ForceNoise {
  // Along each axis of the orbit [m^2/s^3]: gravity beyond its degree, ocean tides, light of the
  // Earth.
  double floor_m2_per_s3 = 1e-14;
  double drag_share = 0.3, drag_s = 6 * 3600.0;
  double radiation_share = 0.05, radiation_s = 3600.0;
};

struct MaintenanceSettings {
  int gravity_degree = 50;
  ForceNoise noise;
  double noise_every_s = 3000.0;  // between changes of velocity that stand for the noise
  double window_s = 36 * 3600.0;  // longest that observations are kept for a fit
  double kept_s = 20 * 3600.0;    // what is kept of them when older ones are given up
  // By which a manoeuvre must lower the sum of squares; chi-square of 3 degrees of freedom at the
  // best of many times.
  double manoeuvre_gain = 32.0;
  double manoeuvre_sigma_m_per_s = 3.0;  // expected size of a manoeuvre, along each axis
  double outlier_d2 = 36.0;              // an observation beyond is left out
};

/// Forces by which orbits of a catalogue are kept: those of a flight for paths, simpler ones for
/// derivatives. Immutable; objects and threads share it.
class MaintenanceForces {
 public:
  /// Times between `first` and `last` are covered, at most 20 days.
  MaintenanceForces(const Clock& clock, SimTime first, SimTime last,
                    const MaintenanceSettings& settings = {});

  const Clock& clock() const { return clock_; }
  const MaintenanceSettings& settings() const { return settings_; }
  const ForceModel& derivatives() const { return derivatives_; }
  FlightForces flight(double drag_m2_per_kg, double radiation_m2_per_kg) const;
  /// Standard deviations of a change of velocity along the radius, the motion and the normal
  /// [m/s] that stands for the noise of `duration_s`.
  Eigen::Vector3d noise_m_per_s(const OrbitState& at, double duration_s) const;

 private:
  Clock clock_;
  MaintenanceSettings settings_;
  std::shared_ptr<const EarthSurroundings> surroundings_;
  ForceModel derivatives_;
};

}  // namespace dmise
