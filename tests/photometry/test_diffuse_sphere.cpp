#include "core/photometry/diffuse_sphere.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

TEST(DiffuseSphere, OneMetreAt1000KmHalfLit) {
  EXPECT_NEAR(diffuse_sphere_magnitude({1.0, 0.2}, {.range_m = 1e6, .phase_rad = 90 * deg}), 6.67,
              0.005);
}

// F(0) = 2/(3 pi), F(90 deg) = 2/(3 pi^2), F(180 deg) = 0. Near 180 deg the closed form in long
// double.
TEST(DiffuseSphere, PhaseFunction) {
  EXPECT_DOUBLE_EQ(diffuse_phase_function(0.0), 2 / (3 * pi));
  EXPECT_DOUBLE_EQ(diffuse_phase_function(pi / 2), 2 / (3 * pi * pi));
  EXPECT_EQ(diffuse_phase_function(pi), 0.0);
  EXPECT_EQ(diffuse_phase_function(pi + 1e-9), 0.0);
  double last = 1.0;
  for (double phase = 0.0; phase < pi; phase += 0.001) {
    const double f = diffuse_phase_function(phase);
    EXPECT_LT(f, last) << phase;
    last = f;
  }
  for (const double from_dark : {0.05, 0.0999, 0.1001, 0.2}) {
    const long double e = pi - (pi - from_dark);
    const long double exact = 2 / (3 * pi * (long double)pi) * (std::sin(e) - e * std::cos(e));
    EXPECT_NEAR(diffuse_phase_function(pi - from_dark), double(exact), 1e-9 * double(exact));
  }
}

TEST(DiffuseSphere, FiniteAtEveryPhase) {
  for (const double phase : {0.0, pi / 2, pi - 1e-9, pi, pi + 1e-12}) {
    const double v = diffuse_sphere_magnitude({1.0, 0.2}, {.phase_rad = phase});
    EXPECT_TRUE(std::isfinite(v)) << phase;
    EXPECT_LE(v, darkest_mag);
    EXPECT_TRUE(std::isfinite(object_photons_per_s_m2(v, johnson_v())));
  }
  EXPECT_EQ(object_photons_per_s_m2(darkest_mag, johnson_v()), 0.0);
  EXPECT_EQ(diffuse_sphere_magnitude({1.0, 0.2}, {.sunlit = 0.0}), darkest_mag);
  EXPECT_THROW(diffuse_sphere_magnitude({1.0, 0.2}, {.range_m = 0.0}), Error);
  EXPECT_THROW(diffuse_sphere_magnitude({1.0, 0.2}, {.range_m = NAN}), Error);
}

// The phase integral: a Lambert sphere of albedo rho scatters rho of the light it takes, so the
// mean of rho F over all directions, times 4 pi, is rho.
TEST(DiffuseSphere, ConservesEnergy) {
  double sum = 0.0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double phase = (i + 0.5) * pi / n;
    sum += diffuse_phase_function(phase) * 2 * pi * std::sin(phase) * pi / n;
  }
  EXPECT_NEAR(sum, 1.0, 1e-6);
}

TEST(DiffuseSphere, StandardMagnitudes) {
  const StandardMagnitude half_lit{.v_mag = 4.0};
  EXPECT_NEAR(magnitude_from_standard(half_lit, {.range_m = 1e6, .phase_rad = pi / 2}), 4.0, 1e-12);
  EXPECT_NEAR(magnitude_from_standard(half_lit, {.range_m = 1e7, .phase_rad = pi / 2}), 9.0, 1e-12);
  // Full phase is brighter by 2.5 log10(pi) = 1.243 mag.
  EXPECT_NEAR(magnitude_from_standard(half_lit, {.range_m = 1e6, .phase_rad = 0}), 4.0 - 1.2429,
              1e-4);
  const double radius_m = radius_from_standard(half_lit, 0.2);
  EXPECT_NEAR(diffuse_sphere_magnitude({radius_m, 0.2}, {.phase_rad = pi / 2}), 4.0, 1e-12);
  EXPECT_NEAR(radius_m, std::pow(10, 0.2 * (6.67 - 4.0)), 0.01);
}

// Sun and object differ by the same magnitudes in every band, that of the reference spectra's Sun
// in V: it is grey.
TEST(DiffuseSphere, HasTheColourOfTheSun) {
  const double brighter = light_of_magnitude(sun_v_mag) * zero_point_photons_per_s_m2(johnson_v()) /
                          photon_rate_per_m2(solar_spectrum(), johnson_v());
  for (const char* name : {"bessell-B", "bessell-V", "bessell-I"}) {
    const Band band = *filter_named(name);
    const double expected = brighter * photon_rate_per_m2(solar_spectrum(), band);
    EXPECT_NEAR(object_photons_per_s_m2(sun_v_mag, band), expected, 1e-9 * expected) << name;
  }
}

}  // namespace
}  // namespace dmise
