#pragma once
#include <cstddef>

#include "core/base/image.h"
#include "core/base/pixel.h"

namespace dmise {

/// A circle about a source, and a ring about it from which the background is taken [px].
struct Aperture {
  double radius_px = 4.0;
  double inner_px = 8.0, outer_px = 16.0;  // the ring: pixels whose centres are within
};

/// Throws `Error` "aperture: KEY: reason, got value" unless 0.5 <= radius <= inner < outer <= 500.
void check(const Aperture& aperture);

/// How counts become electrons, and what of them is no measurement.
struct CountScale {
  double gain_e_per_dn = 1.0;  // > 0
  double bias_dn = 0.0;
  double saturation_dn = 65535;  // lowest count that may be clipped
};

/// Light in an aperture.
struct ApertureFlux {
  double flux_e = 0.0;              // above the background
  double sigma_e = 0.0;             // standard deviation of `flux_e`
  double background_e = 0.0;        // mean of a pixel of the ring
  double background_sigma_e = 0.0;  // standard deviation of a pixel of the ring
  double area_px = 0.0;             // sum of the pixels' parts in the aperture
  std::size_t ring_pixels = 0;      // that were not clipped
  bool saturated = false;           // a pixel of the aperture
};

/// Area of the unit pixel centred on (x, y) that lies in the circle of radius `radius` about the
/// origin, [0, 1]. Exact.
double pixel_in_circle(double x, double y, double radius);

/// Sums the light of a source at `centre`. A pixel counts by the area of it that is in the circle;
/// the background is the mean of the ring's pixels, clipped at 3 standard deviations about their
/// median up to 5 times. The variance is the ring's scatter over the aperture, that of the
/// background's mean, and the Poisson variance of the source's own light. Throws `Error` if
/// aperture or ring are not wholly in the frame.
ApertureFlux aperture_flux(const CountImage& counts, const CountScale& scale, PixelPosition centre,
                           const Aperture& aperture);

}  // namespace dmise
