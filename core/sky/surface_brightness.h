#pragma once
#include <optional>
#include <string_view>

#include "core/photometry/band.h"
#include "core/photometry/spectrum.h"

// Brightness of the sky. Inside, parts of the sky are in S10: stars of V = 10 per square degree,
// linear and additive (27.78 mag/arcsec2 is 1 S10); at the edges mag/arcsec2, in images
// photons/s/m2/sr.
namespace dmise {

double s10_of_mag_per_arcsec2(double v_mag_per_arcsec2);
/// `s10` > 0.
double mag_per_arcsec2_of_s10(double s10);
/// Source of the scale of nanolamberts: Krisciunas & Schaefer 1991, PASP 103, 1033, equation 1.
double s10_of_nanolambert(double nanolambert);

/// Photons/s/m2/sr in `band` of a surface of 1 S10 (V) whose light has the colour of `spectrum`
/// (any scale). Throws `Error` when the band reaches beyond the spectrum.
double photons_per_s_m2_sr_of_s10(const Band& band, const Spectrum& spectrum = sunlight_spectrum());

/// The whole sky in one figure: V brightness at the zenith [mag/arcsec2] by name: "urban" 18
/// (Atlanta-like), "suburban" 20, "dark" 21.9 (an observatory), "space" 22.0 (zodiacal light 90 deg
/// from the Sun in the ecliptic: 202 S10).
std::optional<double> zenith_brightness_named(std::string_view preset);

}  // namespace dmise
