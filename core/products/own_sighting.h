#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/base/sim_time.h"
#include "core/products/measured_number.h"

namespace dmise {

/// What a sensor of the user's saw in one direction.
struct OwnSighting {
  SimTime time;  // reception, within the exposure
  // ICRS, from the sensor to where the light or the echo left the object: without aberration and
  // refraction.
  double ra_rad = 0.0, dec_rad = 0.0;
  std::array<double, 3> covariance_rad2{};  // var(ra cos dec), cov, var(dec)
  std::optional<MeasuredNumber> magnitude;  // V-solar, above the atmosphere
  double snr = 0.0;                         // 0: unknown
  std::optional<MeasuredNumber> range_m;    // length of that line
  // Its derivative by the time of reception, with the motion of the sensor.
  std::optional<MeasuredNumber> range_rate_m_per_s;
};

/// What such a sensor says of one exposure.
struct Observed {
  double boresight_ra_rad = 0.0, boresight_dec_rad = 0.0;  // ICRS, at mid exposure
  std::optional<double> limiting_magnitude;                // V-solar
  std::vector<OwnSighting> sightings;
};

}  // namespace dmise
