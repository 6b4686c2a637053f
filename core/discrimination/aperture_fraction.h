#pragma once
#include "core/discrimination/aperture_photometry.h"
#include "core/optics/camera.h"

namespace dmise {

/// Fraction of a point's light that falls in an aperture about it, where pixels count by their area
/// within: the mean over places of the point on its pixel, from the transfer functions of optics
/// and pixel at `wavelength_m`. It is known to 1e-3 for radii of 3 px and more in frames of this
/// program, whose point spread ends where the plan of the blur says. Throws `Error` for optics with
/// aberrations, whose point spread is not round, and for a radius <= 0.
double aperture_fraction(const Optics& optics, double wavelength_m, double radius_px);

/// Fraction of what is above the background of the ring, which has some of the point's own light:
/// for an Airy pattern and the usual aperture 0.2 to 0.3 % of it.
double aperture_fraction(const Optics& optics, double wavelength_m, const Aperture& aperture);

}  // namespace dmise
