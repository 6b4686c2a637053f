#pragma once
#include <optional>

#include "core/frames/earth_orientation.h"
#include "core/frames/geodesy.h"
#include "core/sky/air/refraction.h"
#include "core/sky/places/sun_moon.h"

namespace dmise {

/// The air over a ground observer.
struct Air {
  Vec<Gcrs> zenith;  // unit, normal of the ellipsoid
  Refraction refraction;
};

/// A camera at one instant.
struct Observer {
  Tt time;
  SolarSystem solar_system;
  Vec<Gcrs> position_m;        // geocentric
  Vec<Gcrs> velocity_m_per_s;  // geocentric
  std::optional<Air> air;      // none in space
};

Observer ground_observer(const Site& site, const EarthOrientation& earth, SimTime t, const Tt& tt,
                         const SolarSystem& solar_system, const Refraction& refraction);
Observer space_observer(const Vec<Gcrs>& position_m, const Vec<Gcrs>& velocity_m_per_s,
                        const Tt& tt, const SolarSystem& solar_system);

/// From the barycentre of the solar system [au].
Vec<Gcrs> barycentric_au(const Observer& observer);

}  // namespace dmise
