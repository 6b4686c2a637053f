#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/standard_air.h"
#include "core/sky/air/sunlit_air.h"
#include "core/sky/bodies/limb_extinction.h"
#include "core/sky/limb_air.h"

namespace dmise {
namespace {

constexpr double radius_m = 6371e3;
const OblateEarth sphere{.ellipsoid = {radius_m, 0.0}};

Band line(double wavelength_nm) { return {"line", wavelength_nm * nm, 1 * nm, {}}; }

struct Row {
  double height_m, sun_deg, towards_sun, wavelength_nm, light;
};
constexpr Row rows[] = {
#include "tests/sky/limb_air_reference.inc"
};

const LimbAirTable& table_of(double wavelength_nm) {
  static const LimbAirTable blue(line(450)), green(line(550)), red(line(850));
  return wavelength_nm < 500 ? blue : wavelength_nm < 600 ? green : red;
}
double sunlight(double wavelength_nm) {
  return sunlight_photons_per_s_m2(sun_v_mag, line(wavelength_nm));
}

// Reference: sums along lines of sight and of sunlight by numpy (tests/reference/limb_light.py
// air): tangent heights of 0.2 to 95 km, the Sun 20 to 101 deg from the zenith on all sides. Within
// 5 % and 0.3 % of the brightest height over the same place.
TEST(LimbAir, SunlitAirIsThatOfTheSums) {
  double worst = 0.0, worst_integral = 0.0;
  for (const Row& row : rows) {
    const LimbSun at{row.height_m, row.sun_deg * deg, row.towards_sun};
    const double scale = sunlight(row.wavelength_nm);
    double brightest = 0.0;
    for (const Row& other : rows)
      if (other.sun_deg == row.sun_deg && other.towards_sun == row.towards_sun &&
          other.wavelength_nm == row.wavelength_nm)
        brightest = std::max(brightest, other.light);
    const double light = table_of(row.wavelength_nm).scattered(at) / scale;
    const double exact = table_of(row.wavelength_nm).integrated(at) / scale;
    EXPECT_NEAR(light, row.light, 0.05 * row.light + 0.003 * brightest + 1e-10)
        << row.height_m << " " << row.sun_deg << " " << row.towards_sun << " " << row.wavelength_nm;
    EXPECT_NEAR(exact, row.light, 0.02 * row.light + 0.003 * brightest + 1e-10)
        << row.height_m << " " << row.sun_deg << " " << row.towards_sun << " " << row.wavelength_nm;
    if (row.light > 0.1 * brightest && brightest > 1e-7) {
      worst = std::max(worst, std::abs(light / row.light - 1.0));
      worst_integral = std::max(worst_integral, std::abs(exact / row.light - 1.0));
    }
  }
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("worst_integral", std::to_string(worst_integral));
}

// The table against the integral that it was made of, between all of its nodes: within 5 %, and
// 0.3 % of the brightest height at the same place, which is that of the airglow at least.
TEST(LimbAir, TheTableIsTheIntegral) {
  double worst = 0.0;
  std::uint32_t state = 1;
  const auto random = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296.0; };
  for (const double wavelength_nm : {450.0, 550.0, 850.0})
    for (int i = 0; i < 500; ++i) {
      const double height_m = 110e3 * random(), day = random();
      const LimbSun at{height_m, (day < 0.4 ? 200.0 * day : 80.0 + 55.0 * (day - 0.4)) * deg,
                       2.0 * random() - 1.0};
      const auto& table = table_of(wavelength_nm);
      const double light = table.scattered(at), exact = table.integrated(at);
      double brightest = 1e-7 * sunlight(wavelength_nm);
      for (double z = 0.5e3; z < 80e3; z += 4e3)
        brightest = std::max(brightest, table.integrated({z, at.sun_zenith_rad, at.towards_sun}));
      EXPECT_NEAR(light, exact, 0.05 * exact + 0.003 * brightest)
          << height_m << " " << at.sun_zenith_rad / deg << " " << at.towards_sun;
      if (exact > 0.1 * brightest) worst = std::max(worst, std::abs(light / exact - 1.0));
    }
  RecordProperty("worst", std::to_string(worst));
}

double air_towards_sun(double height_m, double cosine) {
  const auto& columns = AirColumns::standard();
  const auto level = columns.level(height_m);
  if (cosine >= 0.0) return columns.upwards(level, cosine).air;
  const double lowest_m = (radius_m + height_m) * std::sqrt(1 - cosine * cosine) - radius_m;
  return columns.downwards(level, cosine, lowest_m).air;
}

// Chapman's grazing function of an even temperature, sqrt(pi r / (2 H)) H of the air above, in the
// isothermal layer, H = 216.65 K / 0.0341632 K/m; the air over it is a little warmer.
TEST(LimbAir, GrazingSunlightPassesTheAirOfChapman) {
  double column_m = 0.0;
  for (double z = 5.0; z < 120e3; z += 10.0) column_m += 10.0 * relative_density(z);
  const double h = 216.65 / 0.0341632;
  for (const double height_m : {11e3, 13e3, 15e3}) {
    const double chapman =
        relative_density(height_m) * std::sqrt(pi / 2 * (radius_m + height_m) * h) / column_m;
    EXPECT_NEAR(air_towards_sun(height_m, 0.0) / chapman, 1.0, 0.01) << height_m;
    // Down and up again: twice that of the lowest place without what is behind.
    const double cosine = -std::sqrt(1 - std::pow((radius_m + height_m) / (radius_m + 90e3), 2));
    EXPECT_NEAR(air_towards_sun(90e3, cosine) / (2 * chapman), 1.0, 0.01);
  }
  EXPECT_NEAR(air_towards_sun(0.0, 1.0), 1.0, 2e-3);
  EXPECT_NEAR(air_towards_sun(0.0, 0.5), 2.0, 1e-2);
  // Bemporad's 38 airmasses at the horizon, without refraction 36 (Kasten & Young 1989: 37.9).
  EXPECT_NEAR(air_towards_sun(0.0, 0.0), 36.0, 1.5);
}

// Bucholtz 1995, Applied Optics 34, 2765: 4.513e-31 m2 a molecule at 550 nm; U.S. Standard
// Atmosphere 1976: 6.439e21 /m3 at 60 km, density falls by e in 7.88 km. Thin air gives cross
// section x density x sqrt(2 pi r H) / (4 pi) of sunlight.
TEST(LimbAir, ThinAirHasTheLightOfItsMolecules) {
  const double expected =
      4.513e-31 * 6.439e21 * std::sqrt(2 * pi * (radius_m + 60e3) * 7.88e3) / (4 * pi);
  const double light = table_of(550).scattered({60e3, 40 * deg, 0.0}) / sunlight(550);
  EXPECT_NEAR(light / expected, 1.0, 0.03);
  RecordProperty("over_molecules", std::to_string(light / expected));
}

TEST(LimbAir, IsBlueAndFallsByTheScaleHeight) {
  const auto light = [](double wavelength_nm, double height_m) {
    return table_of(wavelength_nm).scattered({height_m, 50 * deg, 0.3}) / sunlight(wavelength_nm);
  };
  // As the wavelength to the power -4.08 in thin air.
  EXPECT_NEAR(light(450, 70e3) / light(850, 70e3), std::pow(850.0 / 450.0, 4.08), 0.4);
  // Density falls by e in 6.6 to 8.1 km from 30 to 60 km.
  const double falls_m = 30e3 / std::log(light(850, 30e3) / light(850, 60e3));
  EXPECT_NEAR(falls_m, 7.3e3, 0.4e3);
  // Near the ground blue light is as bright as thick air lets it be.
  EXPECT_LT(light(450, 1e3), 2.0 * light(450, 20e3));
  EXPECT_GT(light(850, 1e3), 3.0 * light(850, 20e3));
}

/// Directions over the limb of a night or day side, from an orbit.
double seen(const Vec<Gcrs>& from_m, const Vec<Gcrs>& direction, const Vec<Gcrs>& sun_m,
            const OblateEarth& earth = sphere) {
  const LimbAirRadiance air(line(550), sun_m, earth);
  return air.photons_per_s_m2_sr(LimbSight(from_m, earth).line(direction), unit(direction));
}

// The Sun exactly behind the limb, beside it, behind the observer and below: finite everywhere,
// dark in full night, and none before the ground.
TEST(LimbAir, IsFiniteForEverySunAndObserver) {
  for (const double from_m : {1e3, 20e3, 60e3, 109e3, 200e3, 800e3, 35786e3, 4e8})
    for (int k = 0; k < 36; ++k) {
      const Vec<Gcrs> sun_m{std::cos(k * 10 * deg) * au_m, std::sin(k * 10 * deg) * au_m, 0.0};
      for (double height_m = -6e6; height_m < 200e3; height_m += height_m < -10e3 ? 3e5 : 1.7e3)
        for (const double side : {1.0, -1.0}) {
          const double sine = std::min(1.0, (radius_m + height_m) / (radius_m + from_m));
          const Vec<Gcrs> down{-std::sqrt(1 - sine * sine), side * sine, 0};
          const double here = seen({radius_m + from_m, 0, 0}, down, sun_m);
          ASSERT_TRUE(std::isfinite(here) && here >= 0.0) << from_m << " " << k << " " << height_m;
          ASSERT_TRUE(here == 0.0 || height_m >= 0.0);
        }
    }
  // The antisolar point below: all of the limb is in the shadow.
  const Vec<Gcrs> behind{au_m, 0, 0};
  const double sine = (radius_m + 30e3) / (radius_m + 400e3);
  EXPECT_EQ(seen({-(radius_m + 400e3), 0, 0}, {std::sqrt(1 - sine * sine), sine, 0}, behind), 0.0);
}

TEST(LimbAir, ThePolesLimbIsWhereTheEllipsoidIs) {
  const OblateEarth earth;
  const Vec<Gcrs> from_m{0, 7.2e6, 0}, sun_m{0, au_m, 0};
  const double b = 6356752.314, a = 6378137.0;
  // Tangent of the ellipse towards the pole.
  const double angle = std::atan(b / std::sqrt(7.2e6 * 7.2e6 - a * a));
  const auto at = [&](double rad) {
    return seen(from_m, {0, -std::cos(rad), std::sin(rad)}, sun_m, earth);
  };
  EXPECT_EQ(at(angle - 1e-6), 0.0);
  EXPECT_GT(at(angle + 1e-6), 0.0);
}

struct Star {
  double from_m, height_m, wavelength_nm, light;
};
constexpr Star stars[] = {
#include "tests/sky/limb_stars_reference.inc"
};

LimbExtinction extinction_from(double from_m, double wavelength_nm) {
  return {line(wavelength_nm), LimbSight({radius_m + from_m, 0, 0}, sphere)};
}
Vec<Gcrs> towards(double from_m, double height_m) {
  const double sine = (radius_m + height_m) / (radius_m + from_m);
  return {-std::sqrt(1 - sine * sine), sine, 0};
}

// Reference: rays traced through the standard atmosphere (tests/reference/limb_light.py stars).
TEST(LimbExtinction, StarsAreDimmedAsTracedRaysAre) {
  double worst_mag = 0.0;
  for (const Star& star : stars) {
    const double light = extinction_from(star.from_m, star.wavelength_nm)
                             .of_point(towards(star.from_m, star.height_m));
    const double mag = std::abs(2.5 * std::log10(light / star.light));
    EXPECT_LT(mag, 0.1) << star.from_m << " " << star.height_m << " " << star.wavelength_nm << ": "
                        << light << " " << star.light;
    worst_mag = std::max(worst_mag, mag);
  }
  RecordProperty("worst_mag", std::to_string(worst_mag));
}

TEST(LimbExtinction, DimsWhatIsBehindTheAirAlone) {
  const auto air = extinction_from(500e3, 550);
  const Vec<Gcrs> low = towards(500e3, 15e3);
  EXPECT_EQ(air.of_point(low, 1000e3), 1.0);  // nearer than the tangent place, 2590 km away
  EXPECT_LT(air.of_point(low, 5000e3), 0.5);
  EXPECT_NEAR(air.of_point(low, 1e13) / air.of_point(low), 1.0, 1e-3);
  EXPECT_EQ(air.of_point(towards(500e3, 101e3)), 1.0);
  EXPECT_EQ(air.of_point({1, 0, 0}), 1.0);
  EXPECT_EQ(air.of_surface(Vec<Gcrs>{1, 0, 0}), 1.0);
}

TEST(LimbExtinction, IsFiniteAndGrowsDownwards) {
  for (const double wavelength_nm : {310.0, 450.0, 550.0, 1600.0, 10e3})
    for (const double from_m : {5e3, 50e3, 200e3, 2000e3, 35786e3, 4e8}) {
      const auto air = extinction_from(from_m, wavelength_nm);
      double before = 1.0;
      for (double height_m = std::min(from_m, 120e3); height_m > -100e3; height_m -= 500.0) {
        const double surface = air.of_surface(towards(from_m, height_m));
        const double point = air.of_point(towards(from_m, height_m));
        ASSERT_TRUE(surface >= 0.0 && surface <= before) << height_m;
        ASSERT_TRUE(point >= 0.0 && point <= 1.0) << height_m;
        before = surface;
      }
      for (int i = 0; i <= 180; ++i)
        ASSERT_TRUE(
            std::isfinite(air.of_point({-std::cos(i * deg), std::sin(i * deg), 0}, i * 1e5)));
    }
}

}  // namespace
}  // namespace dmise
