#include "core/discrimination/aperture_photometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"

namespace dmise {
namespace {

TEST(PixelInCircle, SumsToTheAreaOfTheCircle) {
  for (const double radius : {0.3, 0.5, 0.71, 1.0, 2.5, 4.0, 7.3})
    for (const double x0 : {0.0, 0.13, -0.5})
      for (const double y0 : {0.0, 0.41}) {
        double sum = 0.0;
        for (int y = -9; y <= 9; ++y)
          for (int x = -9; x <= 9; ++x) sum += pixel_in_circle(x - x0, y - y0, radius);
        EXPECT_NEAR(sum, pi * radius * radius, 1e-10) << radius << " " << x0 << " " << y0;
      }
}

// Reference: a million points of each pixel.
TEST(PixelInCircle, IsTheShareOfPointsInside) {
  for (const auto& [x, y, radius] : {std::array{2.9, 1.1, 3.0}, std::array{0.2, 0.1, 0.4},
                                     std::array{0.0, 3.4, 3.0}, std::array{-2.0, 2.0, 2.9}}) {
    constexpr int points = 1000;
    int inside = 0;
    for (int j = 0; j < points; ++j)
      for (int i = 0; i < points; ++i)
        inside += std::hypot(x - 0.5 + (i + 0.5) / points, y - 0.5 + (j + 0.5) / points) <= radius;
    EXPECT_NEAR(pixel_in_circle(x, y, radius), inside * 1e-6, 2e-4);
  }
}

// An even background and a source of 1000 counts in one pixel.
TEST(ApertureFlux, LeavesOutTheBackgroundOfTheRing) {
  CountImage counts(64, 64, 1200);
  counts.at(30, 33) = 2200;
  counts.at(30 + 10, 33) = 60000;  // a star in the ring is clipped
  const auto flux = aperture_flux(counts, {.gain_e_per_dn = 1.6, .bias_dn = 1000}, {30, 33}, {});
  EXPECT_NEAR(flux.flux_e, 1600.0, 1e-9);
  EXPECT_NEAR(flux.background_e, 320.0, 1e-9);
  EXPECT_NEAR(flux.area_px, pi * 16, 1e-9);
  EXPECT_NEAR(flux.sigma_e, std::sqrt(1600.0), 1e-9);  // nothing but its own light scatters
  EXPECT_FALSE(flux.saturated);
  counts.at(31, 33) = 65535;
  EXPECT_TRUE(aperture_flux(counts, {}, {30, 33}, {}).saturated);
}

// Gaussian noise of 8 counts: the flux of no source scatters by its sigma about 0.
TEST(ApertureFlux, StatesItsScatter) {
  const RngKey key = rng_key(3, "noise", 1, "draws");
  double sum = 0.0, z_square = 0.0;
  constexpr int frames = 600;
  for (std::uint32_t f = 0; f < frames; ++f) {
    CountImage counts(40, 40);
    for (std::uint32_t i = 0; i < 1600; ++i)
      counts.pixels[i] =
          std::uint16_t(std::lround(1000.0 + 8.0 * double(normal_of(rng_word(key, i, f)))));
    const auto flux =
        aperture_flux(counts, {.gain_e_per_dn = 2.0, .bias_dn = 900}, {19.3, 20.1}, {});
    sum += flux.flux_e / flux.sigma_e;
    // Without the Poisson term of light that only noise gave.
    const double sigma = std::sqrt(flux.sigma_e * flux.sigma_e - std::max(0.0, flux.flux_e));
    z_square += std::pow(flux.flux_e / sigma, 2);
  }
  EXPECT_NEAR(sum / frames, 0.0, 4.0 / std::sqrt(frames));
  EXPECT_NEAR(std::sqrt(z_square / frames), 1.0, 4.0 / std::sqrt(2.0 * frames));
}

TEST(ApertureFlux, RefusesARingBeyondTheFrame) {
  const CountImage counts(64, 64, 1000);
  EXPECT_THROW(aperture_flux(counts, {}, {15.0, 30.0}, {}), Error);
  EXPECT_THROW(aperture_flux(counts, {}, {30.0, 48.0}, {}), Error);
  EXPECT_THROW(aperture_flux(counts, {}, {std::nan(""), 30.0}, {}), Error);
  EXPECT_THROW(check(Aperture{.radius_px = 4, .inner_px = 3, .outer_px = 9}), Error);
  EXPECT_THROW(check(Aperture{.radius_px = std::nan("")}), Error);
}

}  // namespace
}  // namespace dmise
