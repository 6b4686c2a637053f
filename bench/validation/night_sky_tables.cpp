#include <array>

#include "bench/validation/sky_tables.h"
#include "core/base/formatted.h"
#include "core/photometry/band.h"
#include "core/sky/air/extinction.h"
#include "core/sky/sky_model.h"

// Published brightness of the dark, moonlit and twilight sky.
namespace dmise {
namespace {

constexpr Vec<Enu> zenith{0, 0, 1};

/// Sun 40 deg down, and the north galactic pole in the zenith.
SkyScene dark_night() {
  SkyScene scene;
  scene.sun = towards(0, -40);
  const double ra_rad = 192.86 * deg;
  const Vec<Gcrs> up = from_spherical<Gcrs>(ra_rad, 27.13 * deg);
  const Vec<Gcrs> east{-std::sin(ra_rad), std::cos(ra_rad), 0};
  const Vec<Gcrs> north = cross(up, east);
  scene.gcrs_from_enu.m = {
      {{east.x, north.x, up.x}, {east.y, north.y, up.y}, {east.z, north.z, up.z}}};
  return scene;
}

/// Vega magnitude of a square arc second.
double surface_mag(const SkyParts& parts, const SkyScene& scene, const char* filter,
                   const char* site, const Vec<Enu>& direction = zenith) {
  const Band band = *filter_named(filter);
  const SkyModel sky(parts, scene, band, *extinction_of_site(site));
  return magnitude_of_light(sky.photons_per_s_m2_sr(direction) * arcsec * arcsec /
                            zero_point_photons_per_s_m2(band));
}

constexpr std::array filters{"bessell-U", "bessell-B", "bessell-V", "bessell-R", "bessell-I"};
const std::vector<std::string> ubvri{"U", "B", "V", "R", "I"};

SkyTable dark_sky() {
  struct Site {
    const char *what, *extinction;
    double solar_flux_sfu;
    std::array<double, filters.size()> mag;
  };
  constexpr Site sites[] = {
      {"Paranal 2000-01, 180 sfu (Patat 2003, A&A 400, 1183)",
       "paranal",
       180,
       {22.28, 22.64, 21.61, 20.87, 19.71}},
      {"La Palma, 70 sfu (Benn & Ellison 1998, ING TN 115)",
       "la_palma",
       70,
       {22.0, 22.7, 21.9, 21.0, 20.0}},
      {"Cerro Tololo 1987, 85 sfu (Walker 1987, NOAO Newsletter 10)",
       "ctio",
       85,
       {22.0, 22.7, 21.8, 20.9, 19.9}},
  };
  SkyTable table{
      .name = "dark",
      .title = "Dark sky at the zenith",
      .about =
          "Vega mag/arcsec2, without a Moon. The Sun's flux is that of the years of the "
          "measurements; "
          "the north galactic pole is in the zenith. The spectrum of airglow is La Palma's, "
          "scaled in I and below 400 nm to Paranal's and ESO's dark sky: U and I are not "
          "independent. "
          "Nights and hours differ by 0.2 to 0.5 mag.",
      .rows_are = "site, the Sun's flux at 10.7 cm",
      .columns = ubvri};
  for (const Site& site : sites) {
    SkyParts parts = *sky_parts_named("dark");
    parts.airglow->solar_flux_sfu = site.solar_flux_sfu;
    SkyRow row{site.what, {}};
    for (std::size_t i = 0; i < filters.size(); ++i)
      row.cells.push_back(
          SkyCell{site.mag[i], surface_mag(parts, dark_night(), filters[i], site.extinction)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

SkyTable moonlit_sky() {
  SkyTable table{.name = "moonlit",
                 .title = "Moonlit sky at the zenith",
                 .about =
                     "Vega mag/arcsec2 of scattered light of the full Moon alone, 45 deg up, by "
                     "ESO's sky calculator (Noll "
                     "et al. 2012; Jones et al. 2013), which is fitted to spectra of Paranal's "
                     "sky. The model is Krisciunas "
                     "& Schaefer 1991 in V, which their own measurements scatter about by 8 to 23 "
                     "%. Other phases "
                     "and directions are not shown; lists of the sky by the age of the Moon do not "
                     "state where the Moon was.",
                 .rows_are = "place",
                 .columns = {"B", "V", "R", "I"}};
  const SkyScene scene{.moon = towards(90, 45), .moon_phase_rad = 0.0};
  SkyParts parts;
  parts.scattered_moonlight = ScatteredMoonlight{};
  constexpr double published[] = {18.21, 18.04, 18.06, 18.18};
  SkyRow row{"Paranal", {}};
  for (std::size_t i = 0; i < std::size(published); ++i)
    row.cells.push_back(
        SkyCell{published[i], surface_mag(parts, scene, filters[i + 1], "paranal")});
  table.rows.push_back(std::move(row));
  return table;
}

SkyTable twilight_colours() {
  struct Polynomial {
    std::array<double, 3> mag;  // coefficients, by powers of the depression less 5 deg
    double night_mag;           // Patat 2003, which is in the measured light
  };
  constexpr Polynomial polynomials[] = {{{11.78, 1.376, -0.039}, 22.28},
                                        {{11.84, 1.411, -0.041}, 22.64},
                                        {{11.84, 1.518, -0.057}, 21.61},
                                        {{11.40, 1.567, -0.064}, 20.87},
                                        {{10.93, 1.470, -0.062}, 19.71}};
  SkyTable table{.name = "twilight",
                 .title = "Twilight at the zenith",
                 .about =
                     "Vega mag/arcsec2 over Paranal by the polynomials of Patat et al. 2006, A&A "
                     "455, 385, table 1. The model "
                     "is built on them, so this tests the code, not the model.",
                 .rows_are = "the Sun below the horizon, deg",
                 .columns = ubvri};
  SkyParts parts;
  parts.twilight = Twilight{};
  for (const double depression_deg : {5.0, 8.0, 11.0, 14.0}) {
    SkyScene scene = dark_night();
    scene.sun = towards(80, -depression_deg);
    SkyRow row{formatted("%g", depression_deg), {}};
    for (std::size_t i = 0; i < filters.size(); ++i) {
      const auto& p = polynomials[i];
      const double x = depression_deg - 5.0;
      const double light = light_of_magnitude(surface_mag(parts, scene, filters[i], "paranal")) +
                           light_of_magnitude(p.night_mag);
      row.cells.push_back(
          SkyCell{p.mag[0] + (p.mag[1] + p.mag[2] * x) * x, magnitude_of_light(light)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

SkyTable twilight_illuminance() {
  struct Light {
    double sun_deg, low_lx, high_lx;
  };
  constexpr Light lights[] = {{-0.83, 410, 585}, {-6, 2, 3.5}, {-12, 0.008, 0.008}};
  SkyTable table{
      .name = "twilight_illuminance",
      .title = "Illuminance of a plane by twilight",
      .about =
          "V magnitudes of the whole sky's light on a horizontal plane, the Sun's being -26.76 at "
          "133.1 klx, beside "
          "the illuminances of the Glossary of Meteorology (AMS: civil, nautical and astronomical "
          "twilight), by their "
          "middle. The light over the sky is that of scattering in spherical air over the "
          "zenith's, and of "
          "`daylight` near sunset; at the zenith it is Patat's. The 0.0006 lx that the Glossary "
          "has at 18 deg "
          "are as much as a dark sky's, and photometry finds no twilight there.",
      .rows_are = "Sun's altitude; published",
      .columns = {"V mag"}};
  SkyParts parts;
  parts.twilight = Twilight{};
  parts.daylight = Daylight{};
  const Band& band = johnson_v();
  for (const Light& light : lights) {
    SkyScene scene;
    scene.sun = towards(0, light.sun_deg);
    const SkyModel sky(parts, scene, band, *extinction_of_site("lick"));
    const double predicted = on_a_plane([&](double altitude_deg, double azimuth_deg) {
      return sky.photons_per_s_m2_sr(towards(azimuth_deg, altitude_deg));
    });
    const double middle_lx = std::sqrt(light.low_lx * light.high_lx);
    table.rows.push_back(
        {light.low_lx < light.high_lx
             ? formatted("%g deg; %g to %g lx", light.sun_deg, light.low_lx, light.high_lx)
             : formatted("%g deg; %g lx", light.sun_deg, light.low_lx),
         {SkyCell{sunlight_v_mag + magnitude_of_light(middle_lx / sunlight_lx),
                  magnitude_of_light(predicted / zero_point_photons_per_s_m2(band))}}});
  }
  return table;
}

}  // namespace

std::vector<SkyTable> night_sky_tables() {
  return {dark_sky(), moonlit_sky(), twilight_colours(), twilight_illuminance()};
}

}  // namespace dmise
