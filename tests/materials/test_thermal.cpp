#include "core/materials/thermal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double stefan_boltzmann = 5.670374419e-8;  // CODATA 2018 [W/m2/K4]

/// Radiance of a black body between two wavelengths [W/m2/sr]: a midpoint sum in their logarithm.
double radiance_w_per_m2_sr(double temperature_k, double low_m, double high_m) {
  constexpr int steps = 20000;
  const double step = std::log(high_m / low_m) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double wavelength_m = low_m * std::exp((i + 0.5) * step);
    sum += planck_w_per_m2_sr_m(wavelength_m, temperature_k) * wavelength_m * step;
  }
  return sum;
}

TEST(BlackBody, RadiatesStefansLawOverAllWavelengths) {
  for (const double t : {3.0, 300.0, 5772.0})
    EXPECT_NEAR(radiance_w_per_m2_sr(t, 1e-9, 1e3) / (stefan_boltzmann * std::pow(t, 4) / pi), 1.0,
                t < 10 ? 1e-6 : 1e-9)
        << t;
}

// Reference: table of black-body fractions F(0 - lambda T), Incropera & DeWitt, table 12.1, whose
// second constant is 1.4387 cm K (5e-5 off).
TEST(BlackBody, FractionsAreThoseOfTheTables) {
  const double whole = stefan_boltzmann * std::pow(1000.0, 4) / pi;
  const auto fraction = [&](double lambda_t_um_k) {
    return radiance_w_per_m2_sr(1000.0, 1e-9, lambda_t_um_k * 1e-9) / whole;
  };
  EXPECT_NEAR(fraction(1000), 0.000321, 5e-7);
  EXPECT_NEAR(fraction(2000), 0.066728, 5e-6);
  EXPECT_NEAR(fraction(5000), 0.633747, 5e-5);
  EXPECT_NEAR(fraction(10000), 0.914199, 5e-5);
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
  const double beyond = radiance_w_per_m2_sr(320, 3e-6, 1e-3);
  EXPECT_GT(beyond / radiance_w_per_m2_sr(320, 1e-9, 1e-3), 0.999);
}

TEST(Emission, OfSomethingColdOrBlackBodyAtZeroIsNone) {
  EXPECT_EQ(planck_w_per_m2_sr_m(1e-6, 0.0), 0.0);
  EXPECT_EQ(emitted_photons_per_s_m2_sr(Material{}, Band{}), 0.0);
}

}  // namespace
}  // namespace dmise
