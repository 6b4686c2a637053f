#pragma once
#include "core/photometry/curve.h"

// Haze (aerosol) of the lower air, as light is scattered by it.
namespace dmise {

/// Optical depth towards the zenith, that at 550 nm times (wavelength / 550 nm)^-exponent.
/// Source: Angstrom 1929, Geografiska Annaler 11, 156.
struct Haze {
  double optical_depth = 0.05;  // at 550 nm
  double angstrom_exponent = 1.3;

  double depth_at(double wavelength_m) const;
  bool operator==(const Haze&) const = default;
};

/// What an extinction curve [mag/airmass] has at 550 nm beyond molecules at this pressure and
/// ozone, as an optical depth, >= 0.
double haze_depth_of_extinction(const Curve& extinction_mag_per_airmass, double pressure_hpa);

/// Height over the ground in which its density falls to 1/e; that of water vapour, too.
inline constexpr double haze_scale_height_m = 2000.0;

/// Share of the extinguished light that it scatters: 0.94 at 450 and 550 nm, 0.91 at 2.2 um in the
/// model of `haze_phase`.
inline constexpr double haze_scattering_albedo = 0.94;

/// Phase function, with a mean of 1 over the sphere, by the cosine of the angle of scattering:
/// three terms of Henyey & Greenstein 1941. Mie's theory for the rural aerosol of Shettle & Fenn
/// 1979 (AFGL-TR-79-0214), mean of the logarithms of 0.45 to 1.65 um, is met to 8 % rms; single
/// wavelengths to 15 %, from 1 deg on (tests/reference/haze_phase.py).
double haze_phase(double cosine);

/// Share of the light that is scattered so little (the term of g = 0.966) that it counts as not
/// scattered where it is scattered again.
inline constexpr double haze_forward_share = 0.056;
/// Legendre moment of the rest, whose mean over the sphere is 1; 1 for l = 0.
double haze_moment(int l);

}  // namespace dmise
