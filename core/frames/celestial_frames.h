#pragma once
#include "core/frames/vec.h"

// Directions of older catalogues and headers on the ICRS axes.
namespace dmise {

/// From the FK5 with a Julian equinox: precession by IAU 1976, then the rotation to Hipparcos.
Vec<Gcrs> icrs_of_fk5(double ra_rad, double dec_rad, double equinox_jyear);

/// From the FK4 with a Besselian equinox, with its E-terms of aberration, without proper motion:
/// Newcomb's precession to B1950, then FK5.
Vec<Gcrs> icrs_of_fk4(double ra_rad, double dec_rad, double equinox_byear);

/// From galactic coordinates (IAU 1958).
Vec<Gcrs> icrs_of_galactic(double longitude_rad, double latitude_rad);

}  // namespace dmise
