#include "core/discrimination/aperture_fraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/psf_plan.h"

namespace dmise {
namespace {

Optics imager() {
  Optics optics{.focal_length_m = 1.26,
                .aperture_m = 0.15,
                .pixel_pitch_m = 5.3695e-6,
                .columns = 512,
                .rows = 512};
  optics.spread.model = PointSpread::Model::diffraction;
  return optics;
}

// Rayleigh's 1 - J0^2(v) - J1^2(v), v = pi D r / lambda: 83.8 % within the first dark ring, 91.0 %
// the second, 93.8 % the third (Born & Wolf, section 8.5.2), for pixels far below the pattern.
TEST(ApertureFraction, OfAnAiryPatternIsRayleighs) {
  Optics optics = imager();
  optics.pixel_pitch_m = 0.2e-6;
  // What frames have within the end of their kernels.
  const double beyond = plan_psf(optics, 0.925e-6, std::nullopt, 1.0).beyond;
  const double airy_px = 0.925e-6 / 0.15 / optics.pixel_angle_rad();
  for (const auto& [ring, share] :
       {std::array{1.2197, 0.838}, std::array{2.2331, 0.910}, std::array{3.2383, 0.938}})
    EXPECT_NEAR(aperture_fraction(optics, 0.925e-6, ring * airy_px) * (1.0 - beyond), share, 1e-3);
}

// A Gaussian of 1.5 px and its pixel: within a radius much larger than both all light, and the
// variance of pixels (1/12 px2 twice) added to its own.
TEST(ApertureFraction, OfAGaussianIsThatOfItsWidth) {
  Optics optics = imager();
  optics.aperture_m = 10.0;  // no diffraction
  optics.spread.model = PointSpread::Model::gaussian;
  optics.psf_fwhm_px = 6.0;
  const double variance = std::pow(6.0 / 2.3548200450309493, 2) + 2.0 / 12.0;
  for (const double radius : {3.0, 5.0, 9.0})
    EXPECT_NEAR(aperture_fraction(optics, 0.55e-6, radius),
                1.0 - std::exp(-radius * radius / 2 / variance), 3e-4);
}

// An Airy pattern has 2 / (pi v) beyond v = pi D r / lambda (Born & Wolf, section 8.5.2, from the
// asymptotes of J0 and J1): what the ring takes for background.
TEST(ApertureFraction, LeavesOutTheWingsInTheRing) {
  const Aperture aperture;
  const double v_per_px = pi * 0.15 * imager().pixel_angle_rad() / 0.925e-6;
  const double ring = 2.0 / pi / v_per_px * (1.0 / aperture.inner_px - 1.0 / aperture.outer_px);
  const double whole = aperture_fraction(imager(), 0.925e-6, aperture.radius_px);
  EXPECT_NEAR((whole - aperture_fraction(imager(), 0.925e-6, aperture)) / (ring / 12.0), 1.0, 0.1);
}

TEST(ApertureFraction, RefusesABlurThatIsNotRound) {
  Optics optics = imager();
  optics.spread.field.coma_m = 1e-7;
  EXPECT_THROW(aperture_fraction(optics, 0.925e-6, 4.0), Error);
  EXPECT_THROW(aperture_fraction(imager(), 0.925e-6, 0.0), Error);
}

}  // namespace
}  // namespace dmise
