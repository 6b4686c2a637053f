#pragma once
#include <vector>

#include "core/effects/effects.h"
#include "core/facets/facet_light.h"

namespace dmise {

/// Sunlight reflected by the Earth onto an object: the Earth as a diffuse sphere of 6371 km,
/// divided into `rings` rings around the nadir as seen from the object, each of 4 x `rings`
/// patches. Clouds, seas and air have one albedo.
struct Earthshine {
  static constexpr EffectFacts facts{
      "earthshine", "sunlight that the Earth throws on objects (off unless asked for)",
      "up to 0.4 of full sunlight on what faces the Earth; all that there is in its shadow",
      "a diffuse Earth, ring by ring", false};

  double albedo = 0.3;
  int rings = 8;
};

/// `earth_m`: the Earth's centre relative to the object; `to_sun`: unit vector, the same for Earth
/// and object. Empty if no lit ground is visible. Throws `Error` for an object inside the Earth.
std::vector<LightSource> earthshine_sources(const Earthshine& earthshine, const Vec<Body>& earth_m,
                                            const Vec<Body>& to_sun);

}  // namespace dmise
