#include "core/sky/day_sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/sky/air/extinction.h"
#include "core/sky/sky_model.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

Vec<Enu> towards(double azimuth_deg, double altitude_deg) {
  return from_spherical<Enu>((90 - azimuth_deg) * deg, altitude_deg * deg);
}

struct Place {
  double sun_deg, altitude_deg, azimuth_deg;  // azimuth from the Sun's
};

double angle_from_sun_rad(const Place& p) {
  return angle_rad(towards(0, p.sun_deg), towards(p.azimuth_deg, p.altitude_deg));
}

/// Radiance over the Sun's irradiance [1/sr].
double over_sunlight(const Band& band, const DayAir& air, const Place& p) {
  const auto sky = kept_day_sky(band, air, std::sin(p.sun_deg * deg));
  return sky->photons_per_s_m2_sr({.sin_altitude = std::sin(p.altitude_deg * deg),
                                   .azimuth_from_sun_rad = p.azimuth_deg * deg,
                                   .cos_angle_from_sun = std::cos(angle_from_sun_rad(p))}) /
         photon_rate_per_m2(sunlight_spectrum(), band);
}

Band line(double wavelength_um) {
  return {.name = "line", .centre_m = wavelength_um * um, .width_m = 1 * nm, .response = {}};
}

DayAir hazy(double depth, double ground_albedo) {
  DayAir air{.ground_albedo = ground_albedo, .gases = {}};
  air.haze.optical_depth = depth;
  return air;
}

// PythonicDISORT in plane layers. Curved air lets more light of a low Sun in: at 12 deg, in the
// thickest haze, 2.6 %.
TEST(DaySky, IsThatOfDiscreteOrdinates) {
  const struct {
    double wavelength_um, haze, albedo;
    Place place;
    double over_sunlight;
  } rows[] = {
#include "tests/sky/day_sky_reference.inc"
  };
  double sum = 0.0;
  for (const auto& row : rows) {
    const double ours =
        over_sunlight(line(row.wavelength_um), hazy(row.haze, row.albedo), row.place);
    EXPECT_NEAR(ours, row.over_sunlight, 0.03 * row.over_sunlight)
        << row.wavelength_um << " um, Sun at " << row.place.sun_deg << ", "
        << row.place.altitude_deg << " " << row.place.azimuth_deg;
    sum += std::abs(ours / row.over_sunlight - 1.0);
  }
  EXPECT_LT(sum / double(std::size(rows)), 0.01);
}

constexpr double suns_deg[] = {10, 20, 35, 50, 70};
constexpr Place looks[] = {{0, 60, 60},  {0, 60, 180}, {0, 45, 90}, {0, 30, 45},
                           {0, 30, 180}, {0, 20, 100}, {0, 15, 135}};
// Turbidity 2.5 of Preetham, Shirley & Smits 1999 is 0.0693 (wavelength / um)^-1.3.
const DayAir clear_air = hazy(0.151, 0.15);

// CIE standard general sky, type 12 (clear, low turbidity), ISO 15469:2004: gradation 1 - exp(-0.32
// / cos Z), indicatrix 1 + 10 (exp(-3 x) - exp(-3 pi / 2)) + 0.45 cos^2 x.
TEST(DaySky, HasTheShapeOfTheStandardClearSky) {
  const auto standard = [](const Place& p) {
    const double x = angle_from_sun_rad(p);
    return (1.0 - std::exp(-0.32 / std::sin(p.altitude_deg * deg))) *
           (1.0 + 10.0 * (std::exp(-3.0 * x) - std::exp(-1.5 * pi)) +
            0.45 * std::cos(x) * std::cos(x));
  };
  for (const double sun_deg : suns_deg) {
    const Place zenith{sun_deg, 90, 0};
    const double at_zenith = over_sunlight(johnson_v(), clear_air, zenith);
    for (Place look : looks) {
      look.sun_deg = sun_deg;
      const double ours = over_sunlight(johnson_v(), clear_air, look) / at_zenith;
      EXPECT_NEAR(magnitude_of_light(ours), magnitude_of_light(standard(look) / standard(zenith)),
                  0.25)
          << sun_deg << " " << look.altitude_deg << " " << look.azimuth_deg;
    }
  }
}

// Hosek & Wilkie's sky is fainter near the Sun and brighter opposite to it than this and the CIE's,
// from which it differs by up to 1.1 mag. Sunlight has 133.1 klx.
TEST(DaySky, IsAsBrightAsThatOfHosekAndWilkie) {
  const struct {
    Place place;
    double cd_per_m2;
  } rows[] = {
#include "bench/validation/hosek_wilkie.inc"
  };
  double sum = 0.0;
  for (const auto& row : rows) {
    const double mag = magnitude_of_light(over_sunlight(johnson_v(), clear_air, row.place) /
                                          (row.cd_per_m2 / 133.1e3));
    EXPECT_NEAR(mag, 0.0, 0.75) << row.place.sun_deg << " " << row.place.altitude_deg << " "
                                << row.place.azimuth_deg;
    sum += mag;
  }
  EXPECT_NEAR(sum / double(std::size(rows)), 0.0, 0.2);
}

// tests/reference/diffuse_sky.py, pvlib 0.16.1. Below 0.45 um SPECTRL2 has an empirical factor of
// its own.
TEST(DaySky, LightsAPlaneAsSpectrl2Does) {
  const struct {
    double sun_deg, wavelength_um, share;
  } rows[] = {
      {60, 0.45, 0.21655}, {60, 0.55, 0.15304}, {60, 0.65, 0.11935}, {60, 0.87, 0.08144},
      {60, 1.04, 0.06484}, {60, 1.63, 0.03783}, {30, 0.45, 0.15725}, {30, 0.55, 0.11565},
      {30, 0.65, 0.09375}, {30, 0.87, 0.06746}, {30, 1.04, 0.05437}, {30, 1.63, 0.03221},
      {20, 0.45, 0.12080}, {20, 0.55, 0.09113}, {20, 0.65, 0.07655}, {20, 0.87, 0.05807},
      {20, 1.04, 0.04739}, {20, 1.63, 0.02851},
  };
  for (const auto& row : rows) {
    DayAir air = hazy(0.15, 0.2);
    air.haze.angstrom_exponent = 1.14;
    air.gases = AirGases{.pwv_mm = 14.2};
    const Band band = line(row.wavelength_um);
    const DaySky sky(band, air, std::sin(row.sun_deg * deg));
    constexpr int heights = 60, azimuths = 36;
    double sum = 0.0;
    for (int i = 0; i < heights; ++i)
      for (int j = 0; j < azimuths; ++j) {
        const double sine = (i + 0.5) / heights;
        const Place p{row.sun_deg, std::asin(sine) / deg, (j + 0.5) * 180.0 / azimuths};
        sum += sine * sky.photons_per_s_m2_sr(
                          {sine, p.azimuth_deg * deg, std::cos(angle_from_sun_rad(p))});
      }
    const double share =
        sum * 2.0 * pi / (heights * azimuths) / photon_rate_per_m2(sunlight_spectrum(), band);
    EXPECT_NEAR(share, row.share, 0.15 * row.share) << row.sun_deg << " " << row.wavelength_um;
  }
}

TEST(DaySky, IsFiniteInEveryAir) {
  const Band bands[] = {line(0.3), line(0.55), line(1.38), line(3.9), johnson_v()};
  DayAir none{.pressure_hpa = 0.0, .ground_albedo = 0.0, .gases = AirGases{0.0, 0.0}};
  none.haze.optical_depth = 0.0;
  DayAir thick = hazy(5.0, 1.0);
  thick.gases = AirGases{100.0, 1100.0};
  DayAir high = hazy(0.0, 0.8);
  high.height_m = 8848.0;
  high.pressure_hpa = 314.0;
  DayAir low = hazy(0.3, 0.2);
  low.height_m = -430.0;
  for (const Band& band : bands)
    for (const DayAir& air : {none, thick, high, low})
      for (const double sun_deg : {90.0, 45.0, 0.5, 0.0, -0.5, -5.0, -30.0, -90.0}) {
        const DaySky sky(band, air, std::sin(sun_deg * deg));
        for (const double altitude_deg : {90.0, sun_deg, 1.0, 0.0, -20.0})
          for (const double azimuth_deg : {0.0, 77.0, 180.0, -180.0}) {
            const Place p{sun_deg, altitude_deg, azimuth_deg};
            const double light = sky.photons_per_s_m2_sr(
                {std::sin(altitude_deg * deg), azimuth_deg * deg, std::cos(angle_from_sun_rad(p))});
            EXPECT_TRUE(std::isfinite(light) && light >= 0.0)
                << band.centre_m << " " << sun_deg << " " << altitude_deg;
          }
      }
}

struct Dawn {
  SkyParts parts;
  Band band = johnson_v();

  Dawn() {
    parts.twilight = Twilight{};
    parts.daylight = Daylight{};
  }
  double photons(double sun_altitude_deg, const Vec<Enu>& direction) const {
    SkyScene scene;
    scene.sun = towards(90, sun_altitude_deg);
    return SkyModel(parts, scene, band, *extinction_of_site("lick")).photons_per_s_m2_sr(direction);
  }
};

// The change is at most 1.77 mag for each degree: Patat's zenith has 1.52 at 5 deg, opposite to the
// Sun the shadow of the Earth rises, and at sunrise the aureole comes near. Its rate has no jump,
// but where the Sun's limb rises under the place.
TEST(Daylight, JoinsTwilightWithoutASeam) {
  const Dawn dawn;
  const Vec<Enu> places[] = {towards(0, 90), towards(90, 30), towards(90, 2), towards(270, 20),
                             towards(0, 10)};
  double last[std::size(places)] = {}, last_change[std::size(places)] = {};
  for (double sun_deg = -5.4; sun_deg <= 1.4; sun_deg += 0.03)
    for (std::size_t i = 0; i < std::size(places); ++i) {
      const double here = dawn.photons(sun_deg, places[i]);
      if (last[i] > 0.0) {
        const double change = magnitude_of_light(here / last[i]);
        EXPECT_NEAR(change, 0.0, i == 2 || i == 3 ? 0.054 : 0.05) << sun_deg << " place " << i;
        EXPECT_GT(here, 0.999 * last[i]) << sun_deg << " place " << i;
        if (last_change[i] != 0.0) {
          EXPECT_NEAR(change, last_change[i], i == 2 ? 0.02 : 0.01) << sun_deg << " place " << i;
        }
        last_change[i] = change;
      }
      last[i] = here;
    }
}

TEST(Daylight, LeavesTheNightAsItWas) {
  const Dawn dawn;
  Dawn before;
  before.parts.daylight.reset();
  for (const double sun_deg : {-5.0, -5.5, -8.0, -14.0, -40.0})
    EXPECT_EQ(dawn.photons(sun_deg, towards(70, 20)), before.photons(sun_deg, towards(70, 20)));
  EXPECT_EQ(daylight_share(0.0), 1.0);
  EXPECT_EQ(daylight_share(daylight_from_rad), 0.0);
}

}  // namespace
}  // namespace dmise
