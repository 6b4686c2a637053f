#pragma once
#include <vector>

#include "core/effects/effects.h"
#include "core/facets/facet_light.h"

namespace dmise {

/// Sunlight that the Earth throws on an object: the Earth as a diffuse sphere of 6371 km, cut into
/// `rings` rings around the nadir as the object sees it, each into 4 x `rings` patches. Clouds,
/// seas and air are in the one albedo.
struct Earthshine {
  static constexpr EffectFacts facts{
      "earthshine", "sunlight that the Earth throws on objects (off unless asked for)",
      "up to 0.4 of full sunlight on what faces the Earth; all that there is in its shadow",
      "a diffuse Earth, ring by ring", false};

  double albedo = 0.3;
  int rings = 8;
};

/// `earth_m`: the Earth's centre as seen from the object; `to_sun` unit, for the Earth as for the
/// object. No source where the object sees no lit ground. Throws `Error` for an object inside the
/// Earth.
std::vector<LightSource> earthshine_sources(const Earthshine& earthshine, const Vec<Body>& earth_m,
                                            const Vec<Body>& to_sun);

}  // namespace dmise
