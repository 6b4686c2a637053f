#pragma once
#include <numbers>

// Factors to SI, for input and output: `1.2 * arcsec`, `angle_rad / deg`.
namespace dmise {

inline constexpr double pi = std::numbers::pi;
inline constexpr double deg = pi / 180.0;
inline constexpr double arcmin = deg / 60.0;
inline constexpr double arcsec = deg / 3600.0;
inline constexpr double mas = arcsec * 1e-3;
inline constexpr double km = 1e3;
inline constexpr double um = 1e-6;
inline constexpr double nm = 1e-9;
inline constexpr double au_m = 149597870700.0;  // IAU 2012 Resolution B2
inline constexpr double speed_of_light_m_per_s = 299792458.0;
inline constexpr double planck_j_s = 6.62607015e-34;       // SI 2019
inline constexpr double boltzmann_j_per_k = 1.380649e-23;  // SI 2019
inline constexpr double day_s = 86400.0;
inline constexpr double fwhm_per_sigma = 2.3548200450309493;  // for a Gaussian: 2 sqrt(2 ln 2)

}  // namespace dmise
