#include "core/materials/thermal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double stefan_boltzmann = 5.670374419e-8;  // CODATA 2018 [W/m2/K4]

TEST(BlackBody, RadiatesStefansLawOverAllWavelengths) {
  for (const double t : {3.0, 300.0, 5772.0}) {
    const double total = black_body_radiance_w_per_m2_sr(t, 0.0, 1e3);
    EXPECT_NEAR(total / (stefan_boltzmann * std::pow(t, 4) / pi), 1.0, t < 10 ? 1e-6 : 1e-9) << t;
  }
}

// Reference: table of black-body fractions F(0 - lambda T), Incropera & DeWitt, table 12.1, whose
// second constant is 1.4387 cm K (5e-5 off).
TEST(BlackBody, FractionsAreThoseOfTheTables) {
  const double whole = stefan_boltzmann * std::pow(1000.0, 4) / pi;
  const auto fraction = [&](double lambda_t_um_k) {
    return black_body_radiance_w_per_m2_sr(1000.0, 0.0, lambda_t_um_k * 1e-9) / whole;
  };
  EXPECT_NEAR(fraction(1000), 0.000321, 5e-7);
  EXPECT_NEAR(fraction(2000), 0.066728, 5e-6);
  EXPECT_NEAR(fraction(5000), 0.633747, 5e-5);
  EXPECT_NEAR(fraction(10000), 0.914199, 5e-5);
}

TEST(BlackBody, SpectrumIsTheDerivativeOfTheIntegral) {
  for (const double wavelength_m : {0.5e-6, 3e-6, 10e-6, 50e-6}) {
    const double step = 1e-5 * wavelength_m;
    const double slope =
        black_body_radiance_w_per_m2_sr(300, wavelength_m - step, wavelength_m + step) / (2 * step);
    EXPECT_NEAR(planck_w_per_m2_sr_m(wavelength_m, 300) / slope, 1.0, 1e-5) << wavelength_m;
  }
}

// A surface at room temperature: nothing in the visible, most of it beyond 3 um.
TEST(Emission, OfAWarmPanelIsInfrared) {
  Material m;
  m.temperature_k = 320;
  m.thermal_emissivity = 0.8;
  const double visible = emitted_photons_per_s_m2_sr(m, {.centre_m = 0.55e-6, .width_m = 0.3e-6});
  const double thermal = emitted_photons_per_s_m2_sr(m, {.centre_m = 10e-6, .width_m = 4e-6});
  EXPECT_LT(visible, 1e-1);  // photons/s/m2/sr; the darkest sky has some 1e11
  EXPECT_GT(thermal, 1e20);
  const double beyond = black_body_radiance_w_per_m2_sr(320, 3e-6, 1e-3);
  EXPECT_GT(beyond / black_body_radiance_w_per_m2_sr(320, 0, 1e-3), 0.999);
}

TEST(Emission, OfSomethingColdOrBlackBodyAtZeroIsNone) {
  EXPECT_EQ(planck_w_per_m2_sr_m(1e-6, 0.0), 0.0);
  EXPECT_EQ(emitted_photons_per_s_m2_sr(Material{}, Band{}), 0.0);
  EXPECT_EQ(black_body_radiance_w_per_m2_sr(300, 2e-6, 1e-6), 0.0);
}

}  // namespace
}  // namespace dmise
