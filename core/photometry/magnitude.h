#pragma once
#include "core/photometry/band.h"
#include "core/photometry/magnitude_system.h"

namespace dmise {

/// V magnitude of the Sun at 1 au on which the brightness of objects is based. The reference
/// spectra give it within 0.02.
inline constexpr double sun_v_mag = -26.76;

/// Photons/s/m2 of a source of magnitude 0 in `band`, above the atmosphere: Vega's rate with Vega's
/// magnitude taken off (0.03, but 0.024 in bessell-U). Bands up to 2.195 um. Source: CALSPEC;
/// Bessell & Murphy 2012, PASP 124, 140.
double zero_point_photons_per_s_m2(const Band& band);

/// Zero point in the AB system: 3631 Jy at every wavelength. Source: Oke & Gunn 1983, ApJ 266, 713.
double ab_zero_point_photons_per_s_m2(const Band& band);

/// Photons/s/m2 in `band` of sunlight of magnitude `v_mag` (Johnson V): the Moon, a grey object,
/// the zodiacal light.
double sunlight_photons_per_s_m2(double v_mag, const Band& band);

/// The scale of a system's magnitudes in `band`. Throws `Error` for Vega beyond 2.195 um, where its
/// spectrum ends.
MagnitudeScale magnitude_scale(MagnitudeSystem system, const Band& band);

/// The Johnson V in which catalogues give magnitudes (bessell-V).
const Band& johnson_v();

/// Flux ratio of `mag` magnitudes: 10^(-0.4 mag).
double light_of_magnitude(double mag);
/// Its inverse; `light` > 0.
double magnitude_of_light(double light);

}  // namespace dmise
