#include <gtest/gtest.h>

#include <cmath>

#include "core/optics/psf_kernel.h"

// Reference: GalSim 2.8.5, tests/reference/galsim_psf.py.
#include "tests/reference/galsim_psf.inc"

namespace dmise {
namespace {

constexpr double lambda = 0.55e-6, diameter = 0.3, r0 = 0.1;
constexpr int half = 10, side = 2 * half + 1;

// A kernel three times as large, so that little is lost, against GalSim's image.
void expect_agreement(const Blur& blur, double cell_rad, const double* reference) {
  double lost = 0;
  const PsfKernel k = optical_kernel(blur, cell_rad, 6 * half, &lost);
  const double peak = reference[half * side + half];
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x)
      EXPECT_NEAR(k.at(x, y) * (1 - lost), reference[(y + half) * side + x + half], 1e-3 * peak)
          << x << " " << y;
}

TEST(PsfKernel, OfAClearApertureAgreesWithGalSim) {
  expect_agreement({.wavelength_m = lambda, .aperture_m = diameter}, 0.5 * lambda / diameter,
                   galsim_airy);
}

TEST(PsfKernel, OfAnObscuredApertureAgreesWithGalSim) {
  expect_agreement({.wavelength_m = lambda, .aperture_m = diameter, .obscuration = 0.4},
                   0.5 * lambda / diameter, galsim_obscured_airy);
}

TEST(PsfKernel, OfALongExposureAgreesWithGalSim) {
  // An aperture so large that turbulence alone blurs.
  expect_agreement({.wavelength_m = lambda, .aperture_m = 100, .r0_m = r0}, 0.325 * lambda / r0,
                   galsim_kolmogorov);
}

}  // namespace
}  // namespace dmise
