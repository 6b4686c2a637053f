#pragma once

namespace dmise {

/// Airmass at an apparent altitude [rad]; below 0 held at its value there (37.92). 0.9997 at the
/// zenith. Source: Kasten & Young 1989, Applied Optics 28, 4735.
double airmass(double apparent_altitude_rad);

/// Path through a layer where scattering takes place, by the sine of the altitude (held at 0 below
/// it): 1 at the zenith, 5 at the horizon. Source: Krisciunas & Schaefer 1991, PASP 103, 1033,
/// equation 3.
double scattering_airmass(double sin_altitude);

}  // namespace dmise
