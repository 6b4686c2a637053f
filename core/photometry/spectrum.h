#pragma once
#include <cstddef>

#include "core/photometry/band.h"
#include "core/photometry/curve.h"

namespace dmise {

/// Spectral irradiance [W/m2/m] over wavelength.
struct Spectrum {
  Curve irradiance;
};

/// Returns a spectrum times `factor(wavelength_m)` at each of its wavelengths.
template <class Factor>
Spectrum times(Spectrum spectrum, const Factor& factor) {
  Curve& curve = spectrum.irradiance;
  for (std::size_t i = 0; i < curve.value.size(); ++i)
    curve.value[i] *= factor(curve.wavelength_m[i]);
  return spectrum;
}

/// The Sun at 1 au above the atmosphere, 0.2-5 um. Source: ASTM E490-00a, averaged with triangular
/// weights every 5 nm up to 1.1 um.
const Spectrum& solar_spectrum();
/// The spectrum of reflected sunlight, 0.2-100 um: beyond 5 um a black body of 5050 K, the Sun's
/// brightness temperature at 10 um (Vernazza, Avrett & Loeser 1976, ApJS 30, 1), scaled to be
/// continuous: up to 13 % too bright there, where thermal emission dominates.
const Spectrum& sunlight_spectrum();
/// Vega above the atmosphere, 0.2-2.195 um. Source: CALSPEC alpha_lyr_mod_001, averaged likewise.
const Spectrum& vega_spectrum();

/// Photons/s/m2 of a spectrum in a band: the integral of irradiance x response x wavelength / (h
/// c), exact for both as tabulated. Throws `Error` if the band reaches beyond the spectrum.
double photon_rate_per_m2(const Spectrum& spectrum, const Band& band);

/// Photons of a black body, up to a factor common to all bands, at `temperature_k` > 0, times
/// `factors` over wavelength (the end values hold outside). Relative error below 1e-6 for 1000 K
/// and more.
double black_body_photon_rate(double temperature_k, const Band& band, const Curve& factors = {});
/// Photons of a black body by wavelength, up to the same factor.
double black_body_photons_at(double temperature_k, double wavelength_m);

}  // namespace dmise
