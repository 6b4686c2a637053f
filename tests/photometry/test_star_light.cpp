#include "core/photometry/star_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

// Reference: tests/reference/star_colours.py (astropy's Planck law, scipy's quadrature).
TEST(StarLight, BlackBodyAgreesWithPlancksLaw) {
  const auto band = [](double low, double high) {
    return Band{"hat", (low + high) / 2 * um, (high - low) * um, {}};
  };
  const struct {
    double kelvin, v, i;
  } expected[] = {{3500, 13.860061750734648, 34.07831860609958},
                  {5778, 10.611573149804277, 9.664532313840363},
                  {20000, 8.381646996266502, 2.9679040412997155}};
  for (const auto& [kelvin, v, i] : expected) {
    const double reference = black_body_photon_rate(kelvin, band(0.5, 0.51));
    EXPECT_NEAR(black_body_photon_rate(kelvin, band(0.5, 0.6)) / reference, v, 1e-6 * v);
    EXPECT_NEAR(black_body_photon_rate(kelvin, band(0.8, 0.9)) / reference, i, 1e-6 * i);
  }
}

// Ballesteros 2012: the Sun's B-V of 0.65 gives its effective temperature, 5772 K, to 10 K.
TEST(StarLight, ColourTemperature) {
  EXPECT_NEAR(colour_temperature(0.65).kelvin, 5772, 10);
  EXPECT_FALSE(colour_temperature(0.65).clamped);
  EXPECT_NEAR(colour_temperature(0.0).kelvin, 10125, 1);
}

TEST(StarLight, ColoursOutsideTheFormulaAreClampedAndFlagged) {
  for (const double bv : {-0.674, -5.0, -0.41, 2.01, 5.46, double(NAN), double(INFINITY)}) {
    const ColourTemperature t = colour_temperature(bv);
    EXPECT_TRUE(t.clamped) << bv;
    EXPECT_GT(t.kelvin, 3000) << bv;
    EXPECT_LT(t.kelvin, 22000) << bv;
    EXPECT_TRUE(std::isfinite(StarLight(Band{}).photons_per_s_m2(3.0, bv))) << bv;
  }
}

TEST(StarLight, AStarHasItsVMagnitudeInV) {
  const StarLight light(johnson_v());
  EXPECT_NEAR(light.photons_per_s_m2(0.0, 0.0), 8.99e9, 0.01 * 8.99e9);
  EXPECT_NEAR(light.photons_per_s_m2(5.0, 1.5), 8.99e7, 0.01 * 8.99e7);
}

// Vega is the zero of colours: a black body of B-V = 0 must be near magnitude 0 in the other bands
// too.
TEST(StarLight, VisibleBandsOfAnA0StarAreNearTheirZeroPoints) {
  for (const char* name : {"bessell-B", "bessell-R"}) {
    const Band band = *filter_named(name);
    EXPECT_NEAR(magnitude_of_light(StarLight(band).photons_per_s_m2(0, 0) /
                                   zero_point_photons_per_s_m2(band)),
                0.0, 0.15)
        << name;
  }
}

// Reference: B-V and median U-B of the dwarfs of the Yale Bright Star Catalogue,
// tests/reference/star_colours.py. What docs/models/frames.md says of a black body.
TEST(StarLight, OfABlackBodyAgainstTheColoursOfDwarfs) {
  const double colours[][2] = {{-0.2, -0.79}, {-0.1, -0.46}, {0.0, -0.02}, {0.1, 0.10}, {0.2, 0.10},
                               {0.3, 0.07},   {0.4, -0.02},  {0.5, 0.00},  {0.6, 0.10}, {0.7, 0.24},
                               {0.9, 0.57},   {1.0, 0.80},   {1.2, 0.97}};
  const auto magnitude = [](const char* filter, double bv) {
    const Band band = *filter_named(filter);
    return magnitude_of_light(StarLight(band).photons_per_s_m2(0, bv) /
                              zero_point_photons_per_s_m2(band));
  };
  double worst_b = 0, worst_u = 0;
  for (const auto& [bv, ub] : colours) {
    worst_b = std::max(worst_b, std::abs(magnitude("bessell-B", bv) - bv));
    worst_u = std::max(worst_u, std::abs(magnitude("bessell-U", bv) - (bv + ub)));
  }
  EXPECT_NEAR(worst_b, 0.18, 0.02);
  EXPECT_NEAR(worst_u, 0.88, 0.03);
}

TEST(StarLight, TheTableIsTheIntegralTo1e4) {
  const Band band = *filter_named("sdss-z");
  const StarLight light(band);
  for (double bv = -0.4; bv <= 2.0; bv += 0.0137) {
    const double kelvin = colour_temperature(bv).kelvin;
    const double rate = zero_point_photons_per_s_m2(johnson_v()) *
                        black_body_photon_rate(kelvin, band) /
                        black_body_photon_rate(kelvin, johnson_v());
    EXPECT_NEAR(light.photons_per_s_m2(0.0, bv), rate, 1e-4 * rate) << bv;
  }
}

}  // namespace
}  // namespace dmise
