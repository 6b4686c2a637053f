#include "core/discrimination/spectral_signature.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/discrimination/discrimination_text.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/magnitude.h"

namespace dmise {
namespace {

// ASTM E490: 50 nm about 0.925 um hold 43.1 W/m2 (865 and 858 W/m2/um at 0.92 and 0.93 um), each
// photon 2.1475e-19 J; about 1.425 um 17.0 W/m2 (342 and 337 W/m2/um at 1.42 and 1.43 um)
// and 1.394e-19 J. The zero point of a camera that makes an electron of each photon on 1 m2.
TEST(FullSunlight, IsThatOfTheStandardSpectrum) {
  for (const auto& [centre_m, photons_per_s_m2] :
       {std::array{0.925e-6, 0.0431e3 / 2.1475e-19}, std::array{1.425e-6, 0.0170e3 / 1.394e-19}}) {
    const Band band{.name = "band", .centre_m = centre_m, .width_m = 0.05e-6};
    const double zero_point_mag = -magnitude_of_light(object_photons_per_s_m2(0.0, band));
    EXPECT_NEAR(full_sunlight_e(zero_point_mag, 1.0) / photons_per_s_m2, 1.0, 0.03);
    EXPECT_NEAR(full_sunlight_e(zero_point_mag, 0.5) / full_sunlight_e(zero_point_mag, 1.0), 0.5,
                1e-12);
  }
}

TEST(Reflected, IsIndependentOfTheCamerasScale) {
  const Measured light = reflected({900.0, 75.0}, 3e6, 0.9);
  EXPECT_NEAR(light.value, 900.0 / 2.7e6, 1e-15);
  EXPECT_NEAR(light.value / light.sigma, 12.0, 1e-12);
}

// Reference: moments of a ratio to the second order, Hayya, Armstrong & Gressis 1975, Management
// Science 21, 1338: E[x/y] = mx/my (1 + sy^2/my^2), var = (mx/my)^2 (sx^2/mx^2 + sy^2/my^2).
TEST(FluxRatio, HasNoBiasAtASignalOfTwelveSigma) {
  const RngKey key = rng_key(1, "ratio", 1, "draws");
  double sum = 0.0, square = 0.0, z_square = 0.0, plain = 0.0;
  constexpr int draws = 400000;
  for (std::uint32_t i = 0; i < draws; ++i) {
    const Measured a{15.6 + 0.10 * double(normal_of(rng_word(key, i, 0))), 0.10};
    const Measured b{1.0 + double(normal_of(rng_word(key, i, 1))) / 12.0, 1.0 / 12.0};
    const Measured ratio = flux_ratio(a, b);
    sum += ratio.value;
    square += ratio.value * ratio.value;
    z_square += std::pow((ratio.value - 15.6) / ratio.sigma, 2);
    plain += a.value / b.value;
  }
  const double mean = sum / draws, scatter = std::sqrt(square / draws - mean * mean);
  // What is left is 15 / 12^6 of the ratio.
  EXPECT_NEAR(mean, 15.6 * (1.0 + 15.0 / std::pow(12.0, 6)), 4 * scatter / std::sqrt(draws));
  EXPECT_NEAR(plain / draws, 15.6 * (1.0 + 1.0 / 144.0 + 3.0 / std::pow(12.0, 4)),
              4 * scatter / std::sqrt(draws));
  EXPECT_NEAR(scatter / std::hypot(0.10, 15.6 / 12.0), 1.0, 0.04);
  EXPECT_NEAR(std::sqrt(z_square / draws), 1.0, 0.05);
}

TEST(FluxRatio, RefusesADenominatorWithoutLight) {
  EXPECT_THROW(flux_ratio({1.0, 0.1}, {0.0, 0.1}), Error);
  EXPECT_THROW(flux_ratio({1.0, 0.1}, {-0.2, 0.1}), Error);
}

// What is said of an object that the run lacks, as by a slip of the pen, is no silent nothing.
TEST(Discriminate, RefusesWhatIsSaidOfAnObjectThatTheRunLacks) {
  const Band blue{.name = "blue", .centre_m = 0.5e-6, .width_m = 0.05e-6};
  const Band red{.name = "red", .centre_m = 0.8e-6, .width_m = 0.05e-6};
  const std::vector<MaterialSignature> materials = {{.name = "paint", .reflectance = {0.5, 0.5}}};
  RunSpectra spectra{.sensors = {{.name = "b", .band = blue}, {.name = "r", .band = red}},
                     .samples = {{.object = "panel",
                                  .frame = 1,
                                  .bands = {{.light = {1.0, 0.1}}, {.light = {1.0, 0.1}}}}},
                     .left_out = {"b/2 boom: is at the edge"}};
  EXPECT_EQ(
      discriminate(spectra, materials, {{"panel", "paint"}, {"boom", "paint"}}).objects.size(), 1u);
  EXPECT_THROW(discriminate(spectra, materials, {{"panle", "paint"}}), Error);
  EXPECT_THROW(discriminate(spectra, materials, {{"panel", "pain"}}), Error);
}

}  // namespace
}  // namespace dmise
