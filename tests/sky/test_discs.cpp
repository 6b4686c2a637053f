#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/sun_disc.h"

namespace dmise {
namespace {

const Band v_band = johnson_v();

/// Integral of a radiance over a disc about `centre` (unit), in rings and sectors that grow denser
/// towards the limb.
template <class Radiance>
double integral(const Vec<Gcrs>& centre, double radius_rad, const Radiance& radiance,
                int rings = 400, int sectors = 1600) {
  const Vec<Gcrs> u = unit(cross(Vec<Gcrs>{0.3, -0.2, 0.9}, centre)), v = cross(centre, u);
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    // r = sin(x), which has its nodes close together at the limb.
    const double x = pi / 2 * (i + 0.5) / rings, r = std::sin(x) * std::sin(radius_rad);
    const double c = std::sqrt(1.0 - r * r);
    const double dr = std::cos(x) * pi / 2 / rings * std::sin(radius_rad);
    for (int j = 0; j < sectors; ++j) {
      const double at = 2 * pi * (j + 0.5) / sectors;
      const Vec<Gcrs> line = centre * c + (u * std::cos(at) + v * std::sin(at)) * r;
      sum += std::max(0.0, radiance(line)) * r * dr / c * 2 * pi / sectors;
    }
  }
  return sum;
}

// The magnitude: Krisciunas & Schaefer 1991, equation 9, by hand, with their surge of 35 % at full
// Moon; photons of V = 0: the Vega zero point of the band.
TEST(MoonDisc, IntegratesToTheMagnitudeOfMoonlight) {
  const Vec<Gcrs> moon_m = unit(Vec<Gcrs>{1, 2, -0.5}) * 384.4e6;
  const Vec<Gcrs> aside = unit(cross(moon_m, Vec<Gcrs>{0, 0, 1}));
  struct Row {
    double phase_deg, v_mag;
  };
  for (const Row& row : {Row{0, -12.73 - 0.3258}, Row{30, -11.94676}, Row{60, -11.11816},
                         Row{90, -10.12756}, Row{120, -8.78056}, Row{150, -6.805}}) {
    const double a = row.phase_deg * deg;
    const Vec<Gcrs> to_sun = -unit(moon_m) * std::cos(a) + aside * std::sin(a);
    const MoonRadiance moon(v_band, moon_m, moon_m + to_sun * 1.496e11);
    EXPECT_NEAR(moon.phase_rad(), a, 1e-6);
    const double light = integral(unit(moon_m), moon.angular_radius_rad(),
                                  [&](const auto& line) { return moon.photons_per_s_m2_sr(line); });
    const double expected = zero_point_photons_per_s_m2(v_band) * std::pow(10, -0.4 * row.v_mag);
    EXPECT_NEAR(light / expected, 1.0, 3e-3) << row.phase_deg;
    EXPECT_NEAR(moon.photons_per_s_m2() / expected, 1.0, 1e-3) << row.phase_deg;
  }
}

// A closed form against the sum over the sphere.
TEST(MoonDisc, ACrescentEndsAtNewMoon) {
  EXPECT_DOUBLE_EQ(lommel_seeliger_phase(0.0), 1.0);
  EXPECT_EQ(lommel_seeliger_phase(pi), 0.0);
  double before = 1.0;
  for (double phase_deg = 1; phase_deg < 180; phase_deg += 0.25) {
    const double light = lommel_seeliger_phase(phase_deg * deg);
    EXPECT_LT(light, before) << phase_deg;
    EXPECT_GT(light, 0.0) << phase_deg;
    before = light;
  }
  // Series and closed form meet.
  EXPECT_NEAR(lommel_seeliger_phase(pi - 1.999e-3) / lommel_seeliger_phase(pi - 2.001e-3), 0.998,
              1e-4);
  const Vec<Gcrs> moon_m{384.4e6, 0, 0};
  const auto at = [&](double phase_deg) {
    const double a = phase_deg * deg;
    return MoonRadiance(v_band, moon_m,
                        moon_m + Vec<Gcrs>{-std::cos(a), std::sin(a), 0} * 1.496e11);
  };
  // The magnitude goes on without a step; the lit limb is never brighter than at full Moon.
  EXPECT_NEAR(moon_disc_v_mag(159.999 * deg), moon_disc_v_mag(160.001 * deg), 1e-3);
  for (const double phase_deg : {160.0, 170.0, 175.0, 178.0, 179.9}) {
    EXPECT_LT(at(phase_deg).max_photons_per_s_m2_sr(), 0.2 * at(8).max_photons_per_s_m2_sr());
    EXPECT_GT(at(phase_deg).photons_per_s_m2(), 0.0);
  }
  EXPECT_EQ(at(180).photons_per_s_m2(), 0.0);
  const MoonRadiance crescent = at(176);
  const double light = integral(
      {1, 0, 0}, crescent.angular_radius_rad(),
      [&](const auto& line) { return crescent.photons_per_s_m2_sr(line); }, 4000, 1600);
  EXPECT_NEAR(light / crescent.photons_per_s_m2(), 1.0, 0.01);
}

// Lambert's sphere: 2/3 of the albedo at full phase, (sin a + (pi - a) cos a) / pi of it at phase
// a.
TEST(EarthDisc, IntegratesToALambertSphere) {
  const OblateEarth round{.ellipsoid = {6371e3, 0.0}};
  const double albedo = 0.4, distance_m = 1e11;
  const Vec<Gcrs> from_m = unit(Vec<Gcrs>{0.5, -1, 2}) * distance_m;
  const Vec<Gcrs> aside = unit(cross(from_m, Vec<Gcrs>{0, 0, 1}));
  for (const double phase_deg : {0.0, 45.0, 90.0, 135.0, 170.0}) {
    const double a = phase_deg * deg;
    const Vec<Gcrs> sun_m = (unit(from_m) * std::cos(a) + aside * std::sin(a)) * 149597870700.0;
    const EarthRadiance earth(v_band, from_m, sun_m, round, albedo);
    const double light =
        integral(-unit(from_m), std::asin(6371e3 / distance_m),
                 [&](const auto& line) { return earth.photons_per_s_m2_sr(line); });
    const double size = 6371e3 / distance_m;
    const double expected = sunlight_photons_per_s_m2(-26.76, v_band) * 2.0 / 3.0 * albedo * size *
                            size * (std::sin(a) + (pi - a) * std::cos(a)) / pi;
    EXPECT_NEAR(light / expected, 1.0, 3e-3) << phase_deg;
  }
}

// Over the equator and the pole the ellipsoid is seen at its own size, and its normal is geodetic.
TEST(EarthDisc, IsTheEllipsoid) {
  const OblateEarth earth;
  const double distance_m = 42164e3;
  const Vec<Gcrs> sun_m{149597870700.0, 0, 0};
  const EarthRadiance seen(v_band, {distance_m, 0, 0}, sun_m, earth, 0.3);
  const auto limb = [&](const Vec<Gcrs>& towards) {
    double on = 0.0, off = 0.3;
    for (int i = 0; i < 60; ++i) {
      const double angle = 0.5 * (on + off);
      const Vec<Gcrs> line = Vec<Gcrs>{-std::cos(angle), 0, 0} + towards * std::sin(angle);
      (seen.photons_per_s_m2_sr(line) < 0.0 ? off : on) = angle;
    }
    return on;
  };
  EXPECT_NEAR(limb({0, 1, 0}), std::asin(6378137.0 / distance_m), 1e-9);
  // Tangent of an ellipse from a place on its major axis: tan = b / sqrt(d^2 - a^2).
  EXPECT_NEAR(limb({0, 0, 1}),
              std::atan(6356752.314 / std::sqrt(distance_m * distance_m - 6378137.0 * 6378137.0)),
              1e-8);
  // 45 deg of geodetic latitude under a Sun over the equator: the cosine is that of 45 deg.
  const double e2 = 6.69437999014e-3, n = 6378137.0 / std::sqrt(1 - e2 / 2);
  const Vec<Gcrs> ground{n * std::sqrt(0.5), 0, n * (1 - e2) * std::sqrt(0.5)};
  const Vec<Gcrs> line = ground - Vec<Gcrs>{distance_m, 0, 0};
  EXPECT_NEAR(seen.photons_per_s_m2_sr(line) / seen.max_photons_per_s_m2_sr(), std::sqrt(0.5),
              1e-6);
}

TEST(EarthDisc, ItsNightSideIsDark) {
  const EarthRadiance seen(v_band, {-7000e3, 0, 0}, {149597870700.0, 0, 0}, {}, 0.3);
  EXPECT_EQ(seen.photons_per_s_m2_sr({1, 0, 0}), 0.0);
  EXPECT_EQ(seen.photons_per_s_m2_sr({1, 0.5, 0.3}), 0.0);
  EXPECT_LT(seen.photons_per_s_m2_sr({0, 1, 0}), 0.0);
}

// Reference: the limb darkening of Allen's Astrophysical Quantities (Cox 2000), section 14.7, at
// 550 nm: 1 - u - v + u mu + v mu^2, u = 0.93, v = -0.23.
TEST(SunDisc, DarkensTowardsItsLimb) {
  Band narrow{.name = "550", .centre_m = 550e-9, .width_m = 1e-9, .response = {}};
  const SunRadiance sun(narrow, au_m);
  const double centre = sun.photons_per_s_m2_sr(0.0), radius = sun.angular_radius_rad();
  EXPECT_NEAR(radius / deg * 3600, 959.23, 0.05);  // 695,700 km at 1 au
  for (const double mu : {0.9, 0.7, 0.5, 0.3}) {
    const double r = std::asin(std::sqrt(1 - mu * mu) * std::sin(radius));
    const double cox = 0.30 + 0.93 * mu - 0.23 * mu * mu;
    EXPECT_NEAR(sun.photons_per_s_m2_sr(r) / centre, cox, 0.02) << mu;
  }
  EXPECT_LT(sun.photons_per_s_m2_sr(1.0001 * radius), 0.0);
}

TEST(SunDisc, IntegratesToTheSun) {
  const SunRadiance sun(v_band, 0.9832 * au_m);  // in perihelion
  const Vec<Gcrs> centre{0, 0.6, 0.8};
  const double light = integral(centre, sun.angular_radius_rad(), [&](const auto& line) {
    return sun.photons_per_s_m2_sr(angle_rad(line, centre));
  });
  const double expected =
      zero_point_photons_per_s_m2(v_band) * std::pow(10, 0.4 * 26.76) / (0.9832 * 0.9832);
  EXPECT_NEAR(light / expected, 1.0, 1e-3);
}

// 14 mag: Krisciunas & Schaefer's full Moon (-12.73 and the surge) and the Sun's V.
TEST(Moonlight, FullMoonIsFourteenMagnitudesFainterThanTheSun) {
  const Vec<Gcrs> moon_m{384.4e6, 0, 0}, sun_m{-au_m, 0, 0};
  EXPECT_NEAR(-2.5 * std::log10(moonlight_over_sunlight(moon_m, sun_m)), 26.76 - 13.056, 0.005);
  EXPECT_EQ(moonlight_over_sunlight(moon_m, {au_m, 0, 0}), 0.0);
  EXPECT_NEAR(moonlight_colour(v_band), 1.0, 1e-3);
  EXPECT_GT(moonlight_colour(*filter_named("bessell-I")), 1.15);  // it is redder than the Sun
}

}  // namespace
}  // namespace dmise
