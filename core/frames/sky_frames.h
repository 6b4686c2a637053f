#pragma once
#include "core/frames/vec.h"

namespace dmise {

struct Ecliptic {};  // mean ecliptic and equinox of J2000.0
struct Galactic {};  // IAU 1958 system

/// Obliquity 84381.406 arcsec (IAU 2006); the 7 mas between ICRS and the equinox of J2000.0 are
/// left out.
Rotation<Ecliptic, Gcrs> ecliptic_from_gcrs();
/// Source: The Hipparcos and Tycho Catalogues, ESA SP-1200, volume 1, equation 1.5.11.
Rotation<Galactic, Gcrs> galactic_from_gcrs();

}  // namespace dmise
