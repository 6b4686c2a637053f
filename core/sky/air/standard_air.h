#pragma once

// Molecules and ozone of a standard day, without haze and clouds.
namespace dmise {

/// Density of the standard atmosphere over that at the sea, also below it. Source: ISO 2533; U.S.
/// Standard Atmosphere 1976.
double relative_density(double height_m);

/// Refractivity n - 1 at the sea: 15 C and 1013.25 hPa.
double refractivity_at_sea(double wavelength_m);

inline constexpr double sea_level_hpa = 1013.25;
inline constexpr double ozone_column_atm_cm = 0.3;  // 300 DU

/// Ozone [atm-cm/m]: its column in a Gaussian layer at 22 +- 5 km.
double ozone_density(double height_m);

/// Absorption of ozone [1/atm-cm]; held below 300 nm. Source: Bird & Riordan 1986, J. Climate Appl.
/// Meteor. 25, 87.
double ozone_absorption(double wavelength_m);

/// Optical depth of Rayleigh scattering from the sea to the zenith. Source: Hansen & Travis 1974,
/// Space Sci. Rev. 16, 527.
double rayleigh_depth(double wavelength_m);

}  // namespace dmise
