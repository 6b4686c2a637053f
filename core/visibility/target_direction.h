#pragma once
#include "core/sky/places/apparent.h"
#include "core/visibility/pointing.h"

namespace dmise {

/// Refraction above a ground sensor from its configuration, at its band's centre.
Refraction configured_refraction(const SensorConfig& sensor);

/// Unit vector from the sensor of `scene` to the apparent place of an object: with light time, the
/// aberration of the sensor's own motion and refraction, as far as its effects are on. Equals the
/// direction of the object's light in a frame. `refraction` is used on the ground only. Throws
/// `Error` for an object at the observer.
Vec<Gcrs> apparent_direction(const SensorConfig& sensor, const PointingScene& scene,
                             const Refraction& refraction, const Vec<Gcrs>& position_m,
                             const Vec<Gcrs>& slope_m_per_s);

/// Unit vector along which the sensor aims at its target: the apparent direction, or the straight
/// line for `place: geometric`.
Vec<Gcrs> target_direction(const SensorConfig& sensor, const PointingScene& scene,
                           const Refraction& refraction, const Vec<Gcrs>& position_m,
                           const Vec<Gcrs>& slope_m_per_s);

}  // namespace dmise
