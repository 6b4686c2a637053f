#pragma once
#include "core/frames/oblate_earth.h"

namespace dmise {

/// Angle of a direction above the Earth's limb [rad], in the plane of the direction and the Earth's
/// centre; negative where the Earth hides it. `from_m`: outside the ellipsoid; `direction`: of any
/// length > 0. Without the air, which glows some 100 km above: 2 deg from 550 km.
double above_limb_rad(const Vec<Gcrs>& from_m, const Vec<Gcrs>& direction,
                      const OblateEarth& earth);

/// Angle from the limb's nearest point [rad]. It is less than the angle in that plane by 1e-5 of
/// it near the limb, by up to 0.5 deg near the zenith from low orbit.
double from_limb_rad(const Vec<Gcrs>& from_m, const Vec<Gcrs>& direction, const OblateEarth& earth);

}  // namespace dmise
