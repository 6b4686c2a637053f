#pragma once
#include <memory>

#include "core/effects/effects.h"
#include "core/sky/day_sky.h"

namespace dmise {

/// Sunlight scattered by molecules, haze and the ground while the Sun is up; `Twilight` takes over
/// below the horizon.
struct Daylight {
  static constexpr EffectFacts facts{"daylight", "sunlight scattered by the air by day",
                                     "3 to 5 mag/arcsec2 in V, 5 to 8 in J, H and K",
                                     "Lenoble et al. 2007, JQSRT 107, 479; Nakajima & Tanaka 1988, "
                                     "JQSRT 40, 51"};
  static bool applies(const SceneFacts& scene) { return scene.daylight; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double factor = 1.0;
};

/// The Sun's altitude [rad] up to which all of its scattered light is that of `Twilight`.
inline constexpr double daylight_from_rad = -5.0 * 3.14159265358979323846 / 180.0;

/// Share of `Daylight` in the Sun's scattered light, the rest being `Twilight`: 0 to 5 deg below
/// the horizon, 1 from the horizon up, smooth between. The Sun's altitude without refraction [rad].
double daylight_share(double sun_altitude_rad);

/// The sky of a band, air and sine of the Sun's apparent altitude; the last ones made are kept.
std::shared_ptr<const DaySky> kept_day_sky(const Band& band, const DayAir& air,
                                           double sin_sun_altitude);

}  // namespace dmise
