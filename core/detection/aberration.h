#pragma once
#include "core/frames/vec.h"

namespace dmise {

/// Puts right the direction of an Earth satellite that was read off the stars. Catalogue places of
/// stars map to pixels with the aberration of the observer's whole barycentric velocity V + v (V of
/// the Earth, v of the sensor about it); the satellite shares V, so its light carries only that of
/// v. Hence corrected = inverse_v(forward_(V + v)(astrometric)), the geometric direction less light
/// time.
Vec<Gcrs> without_annual_aberration(const Vec<Gcrs>& astrometric,
                                    const Vec<Gcrs>& earth_velocity_m_per_s,
                                    const Vec<Gcrs>& sensor_velocity_m_per_s);

}  // namespace dmise
