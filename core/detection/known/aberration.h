#pragma once
#include "core/frames/vec.h"

namespace dmise {

/// Direction in which an observer moving at `velocity_m_per_s` sees light from the unit direction
/// `from`: exact Lorentz transformation, without the Sun's potential (0.4 uas). With the opposite
/// velocity it is its own inverse. Source: Klioner 2003, AJ 125, 1580, section 5.
Vec<Gcrs> aberrated(const Vec<Gcrs>& from, const Vec<Gcrs>& velocity_m_per_s);

/// Corrects the direction of an Earth satellite measured relative to the stars. A catalogue's stars
/// map to pixels with the aberration of the observer's total barycentric velocity V + v (V the
/// Earth's, v the sensor's relative to it); the satellite shares V, so its light has only the
/// aberration of v. Hence corrected = inverse_v(forward_(V + v)(astrometric)), the geometric
/// direction corrected for light time.
Vec<Gcrs> without_annual_aberration(const Vec<Gcrs>& astrometric,
                                    const Vec<Gcrs>& earth_velocity_m_per_s,
                                    const Vec<Gcrs>& sensor_velocity_m_per_s);

}  // namespace dmise
