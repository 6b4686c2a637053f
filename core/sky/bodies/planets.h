#pragma once
#include <array>
#include <string_view>

#include "core/effects/effects.h"
#include "core/frames/vec.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/julian_date.h"

namespace dmise {

/// Planets other than the Earth. Pluto is none.
enum class Planet { mercury, venus, mars, jupiter, saturn, uranus, neptune };

inline constexpr std::array<Planet, 7> all_planets{Planet::mercury, Planet::venus,  Planet::mars,
                                                   Planet::jupiter, Planet::saturn, Planet::uranus,
                                                   Planet::neptune};

struct PlanetFacts {
  std::string_view name;
  double radius_m;  // equatorial. Source: IAU working group, Archinal et al. 2018, CeMDA 130, 22
  double bv;        // Source: Mallama, Krobusek & Pavlov 2017, Icarus 282, 19
};
const PlanetFacts& facts_of(Planet planet);

/// Place of a planet from the Sun, ICRS axes, geometric [m]: ERFA's eraPlan94 (Simon et al. 1994,
/// A&A 282, 663), brought to JPL's DE423 by sinusoids. Seen from the Earth within 0.4 arcsec of
/// DE423 from 1900 to 2100.
Vec<Gcrs> heliocentric_m(Planet planet, const Tt& tt);

/// Position without the sinusoids, seen from the Earth within 2 arcmin, in a tenth of the time.
Vec<Gcrs> roughly_heliocentric_m(Planet planet, const Tt& tt);

/// The line from an observer at `tt` to a planet `dt_s` later, geometric [m]. `observer_m`: from
/// the Earth's centre; `bodies`: at `tt`.
Vec<Gcrs> planet_line_m(Planet planet, const Tt& tt, const SolarSystem& bodies,
                        const Vec<Gcrs>& observer_m, double dt_s);

/// Where the middle of a planet's light is, whose disc's middle is seen in `direction` (unit).
Vec<Gcrs> photocentre(Planet planet, const Vec<Gcrs>& direction, const Vec<Gcrs>& from_sun_m,
                      const Vec<Gcrs>& from_observer_m);

/// V of a planet above the air for an observer near the Earth. `from_sun_m`, `from_observer_m`: to
/// the planet. Saturn has its rings. Mars is as on the mean of its turn: 0.06 mag. Phase
/// angles are held at the largest that the Earth sees of the outer planets.
/// Source: Mallama & Hilton 2018, Astronomy and Computing 25, 10.
double planet_v_mag(Planet planet, const Vec<Gcrs>& from_sun_m, const Vec<Gcrs>& from_observer_m,
                    const Tt& tt);

/// Light of the planets where they are in the field. They do not scintillate: they are discs of 2
/// to 60 arcsec.
struct Planets {
  static constexpr EffectFacts facts{
      "planets", "Mercury to Neptune, where one is in the field", "no planets in the field",
      "DE423 by eraPlan94 and sinusoids; Mallama & Hilton 2018, A&C 25, 10"};
  static bool applies(const SceneFacts& scene) { return scene.planets_in_field; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
