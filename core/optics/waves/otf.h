#pragma once
#include <limits>

// Optical transfer functions of rotationally symmetric blur in angular frequency nu [cycles/rad].
// All are within 0..1 and 1 at zero frequency.
namespace dmise {

/// Diffraction by a circular aperture with a central obscuration (ratio of diameters, [0, 1)); 0
/// from nu = D / lambda on. Exact. Source: O'Neill 1956, J. Opt. Soc. Am. 46, 285.
double diffraction_otf(double nu_per_rad, double wavelength_m, double aperture_m,
                       double obscuration = 0.0);

/// Long exposure through Kolmogorov turbulence, exp(-3.44 (lambda nu / r0)^(5/3)); r0 may be
/// infinite. Source: Fried 1966, J. Opt. Soc. Am. 56, 1372.
double long_exposure_otf(double nu_per_rad, double wavelength_m, double r0_m);

/// A square pixel's side, sin(pi w nu) / (pi w nu) along one axis; its sign is kept.
double pixel_otf(double nu_per_rad, double pixel_rad);

/// Gaussian pointing jitter (or any Gaussian blur) of standard deviation `sigma_rad` per axis.
double jitter_otf(double nu_per_rad, double sigma_rad);

/// Defocus by the geometrical blur disc of angular diameter `disc_rad`: 2 J1(x) / x, x = pi disc
/// nu; good when the disc is larger than the Airy pattern. Its sign is kept.
double defocus_otf(double nu_per_rad, double disc_rad);

/// Blur of a camera before pixel integration.
struct Blur {
  double wavelength_m = 0.55e-6;
  double aperture_m = 0.1;
  double obscuration = 0.0;
  double r0_m =
      std::numeric_limits<double>::infinity();  // at this wavelength, on the line of sight
  double jitter_rad = 0.0;
  double defocus_disc_rad = 0.0;
};

/// Product of diffraction, long exposure, jitter and defocus.
double optical_otf(const Blur& blur, double nu_per_rad);

}  // namespace dmise
