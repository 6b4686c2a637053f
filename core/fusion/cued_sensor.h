#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "core/base/sim_time.h"
#include "core/frames/geodesy.h"
#include "core/fusion/cue_settings.h"

namespace dmise {

/// A narrow-field sensor on the ground that is cued.
struct CuedSensor {
  std::string name;
  Site site;
  CueSettings cue;
  double park_azimuth_deg = 180.0, park_elevation_deg = 60.0;  // where it stands at first
  double half_angle_rad = 0.0;  // the largest circle in its field, > 0
  double exposure_s = 0.0, cadence_s = 0.0, first_exposure_s = 0.0;

  /// When frame `number`, from 1, begins.
  SimTime exposure_start(std::uint32_t number) const;
  /// The first frame that begins at `t` or later.
  std::uint32_t first_frame_from(SimTime t) const;
};

/// Probability that a normal deviate of two dimensions about 0 falls within `radius`, in its units.
/// Integrated along the longer axis; error below 1e-6.
double probability_in_circle(const Eigen::Matrix2d& covariance, double radius);

}  // namespace dmise
