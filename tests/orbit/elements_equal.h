#pragma once
#include <tuple>

#include "core/orbit/elements.h"

namespace dmise {

/// Equal in every field, to the bit.
inline bool operator==(const MeanElements& a, const MeanElements& b) {
  const auto all = [](const MeanElements& e) {
    return std::tie(e.catalogue_number, e.name, e.designator, e.epoch_jd1, e.epoch_jd2,
                    e.mean_motion_rad_per_min, e.eccentricity, e.inclination_rad, e.raan_rad,
                    e.argument_of_perigee_rad, e.mean_anomaly_rad, e.bstar_per_earth_radius,
                    e.mean_motion_dot_rad_per_min2, e.mean_motion_ddot_rad_per_min3,
                    e.ephemeris_type, e.element_number, e.revolution, e.classification);
  };
  return all(a) == all(b);
}

}  // namespace dmise
