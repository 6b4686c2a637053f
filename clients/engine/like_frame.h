#pragma once
#include <string>

#include "core/config/scenario.h"

namespace dmise {

/// What an exposure of another camera fixes of a sensor that is to make the same image.
struct Likeness {
  std::string sensor;  // empty: the scenario's only one
  std::string start_utc;
  double exposure_s = 0.0;
  int columns = 0, rows = 0;
  double focal_length_px = 0.0;
  double ra_deg = 0.0, dec_deg = 0.0, roll_deg = 0.0;  // as of `PointSky` and `SensorConfig`
  double psf_fwhm_px = 0.0;
  bool sidereal = true;     // else fixed to the ground
  bool guided = false;      // a guided telescope follows the stars' changing refraction as well
  bool extinction = false;  // else the zero point holds the air
};

/// The scenario with that one exposure by one sensor, without stars. Site, objects, band and the
/// other properties of the camera stay. Throws `ConfigError` if there is no such sensor.
Scenario like_frame(Scenario scenario, const Likeness& frame);

}  // namespace dmise
