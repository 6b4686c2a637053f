#include <algorithm>

#include "bench/validation/sky_tables.h"
#include "core/base/formatted.h"
#include "core/photometry/band.h"
#include "core/photometry/spectrum.h"
#include "core/sky/daylight.h"

// Published brightness of the day sky.
namespace dmise {
namespace {

struct SkyPlace {
  double altitude_deg, azimuth_deg;  // from the Sun's
};
constexpr SkyPlace looks[] = {{90, 0},  {60, 60},  {60, 180}, {45, 90},
                              {30, 45}, {30, 180}, {20, 100}};

double from_sun_rad(const SkyPlace& look, double sun_deg) {
  return angle_rad(towards(0, sun_deg), towards(look.azimuth_deg, look.altitude_deg));
}

/// Light over sunlight [1/sr].
double day_sky(const DayAir& air, const SkyPlace& look, double sun_deg) {
  return kept_day_sky(johnson_v(), air, std::sin(sun_deg * deg))
             ->photons_per_s_m2_sr({.sin_altitude = std::sin(look.altitude_deg * deg),
                                    .azimuth_from_sun_rad = look.azimuth_deg * deg,
                                    .cos_angle_from_sun = std::cos(from_sun_rad(look, sun_deg))}) /
         photon_rate_per_m2(sunlight_spectrum(), johnson_v());
}

/// CIE standard general sky, type 12, clear with low turbidity (ISO 15469:2004), of any unit.
double standard_clear_sky(const SkyPlace& look, double sun_deg) {
  const double x = from_sun_rad(look, sun_deg);
  return (1.0 - std::exp(-0.32 / std::sin(look.altitude_deg * deg))) *
         (1.0 + 10.0 * (std::exp(-3.0 * x) - std::exp(-1.5 * pi)) +
          0.45 * std::cos(x) * std::cos(x));
}

std::vector<std::string> names_of_looks() {
  std::vector<std::string> names;
  for (const SkyPlace& look : looks)
    names.push_back(formatted("%g, %g", look.altitude_deg, look.azimuth_deg));
  return names;
}

/// Haze of 0.151 at 550 nm, the turbidity 2.5 of Preetham, Shirley & Smits 1999.
DayAir clear_air() {
  DayAir air{.ground_albedo = 0.15, .gases = {}};
  air.haze.optical_depth = 0.151;
  return air;
}

SkyTable day_of_standards() {
  struct Plane {
    double sun_deg, share;  // skylight over the Sun's illuminance, on a horizontal plane
  };
  // tests/reference/diffuse_sky.py, pvlib 0.16.1.
  constexpr Plane planes[] = {
      {10, 0.05227}, {20, 0.08895}, {35, 0.12118}, {50, 0.13974}, {70, 0.15278}};
  SkyTable table{.name = "day",
                 .title = "Day sky",
                 .about =
                     "V mag/arcsec2 with haze of 0.151 at 550 nm and a ground of albedo 0.15, at "
                     "the sea. Published: the "
                     "CIE's standard clear sky (type 12, ISO 15469:2004) with as much light on a "
                     "horizontal plane as SPECTRL2 "
                     "has there (Bird & Riordan 1986, by pvlib). Both sum up measurements.",
                 .rows_are = "Sun's altitude, deg; look at altitude, azimuth from the Sun",
                 .columns = names_of_looks(),
                 .target_mag = 0.3};
  for (const Plane& plane : planes) {
    const double scale = plane.share / on_a_plane([&](double altitude_deg, double azimuth_deg) {
                           return standard_clear_sky({altitude_deg, azimuth_deg}, plane.sun_deg);
                         });
    SkyRow row{formatted("%g", plane.sun_deg), {}};
    for (const SkyPlace& look : looks)
      row.cells.push_back(SkyCell{mag_of_sunlit(scale * standard_clear_sky(look, plane.sun_deg)),
                                  mag_of_sunlit(day_sky(clear_air(), look, plane.sun_deg))});
    table.rows.push_back(std::move(row));
  }
  return table;
}

SkyTable day_at_the_zenith() {
  constexpr double linke = 3.61;
  SkyTable table{
      .name = "day_zenith",
      .title = "Day sky at the zenith",
      .about = formatted("V mag/arcsec2 beside (1.376 T - 1.81) tan h + 0.38 kcd/m2, fitted to "
                         "measurements in San Francisco (Karayel, Navvab, Ne'eman & "
                         "Selkowitz 1984, Energy and Buildings 6, 283; as in Radiance's gensky), h "
                         "the Sun's altitude. T is taken as Linke's turbidity, by irradiance: "
                         "haze of 0.151 and 14.2 mm of water are %.2f (Kasten 1996, by pvlib). "
                         "Were T that of visible light alone, it would be 2.6 and "
                         "the published sky 0.3 to 0.6 mag fainter.",
                         linke),
      .rows_are = "Sun's altitude, deg",
      .columns = {"zenith"}};
  for (const double sun_deg : {10.0, 20.0, 35.0, 50.0, 70.0}) {
    const double cd_per_m2 = 1e3 * ((1.376 * linke - 1.81) * std::tan(sun_deg * deg) + 0.38);
    table.rows.push_back({formatted("%g", sun_deg),
                          {SkyCell{mag_of_sunlit(cd_per_m2 / sunlight_lx),
                                   mag_of_sunlit(day_sky(clear_air(), looks[0], sun_deg))}}});
  }
  return table;
}

SkyTable day_of_a_model() {
  const struct {
    struct {
      double sun_deg, altitude_deg, azimuth_deg;
    } place;
    double cd_per_m2;
  } published[] = {
#include "bench/validation/hosek_wilkie.inc"
  };
  SkyTable table{
      .name = "day_hosek_wilkie",
      .title = "Day sky by Hosek and Wilkie",
      .about =
          "V mag/arcsec2 beside Hosek & Wilkie 2012 (ACM Trans. Graph. 31, 95), a fit to traced "
          "paths of light, as SatSim 0.27.1 has it: turbidity 2.5, albedo 0.15. "
          "No depth of haze brings them together: at turbidity 1, where their air has no haze, "
          "over black ground their "
          "sky sends down 85 to 94 % of all light that the molecules scatter (the Sun at 20 to 70 "
          "deg), of which half goes up, and is 0.6 to 0.9 mag "
          "brighter than molecules by discrete ordinates; from there to turbidity 2.5 it gains a "
          "fifth, where haze of 0.15 doubles the light (tests/reference/hosek_wilkie.py). It is "
          "fainter near the Sun and brighter opposite to it than the CIE's, too.",
      .rows_are = "Sun's altitude, deg; look at altitude, azimuth from the Sun"};
  for (const auto& p : published) {
    const std::string column = formatted("%g, %g", p.place.altitude_deg, p.place.azimuth_deg);
    if (std::ranges::find(table.columns, column) == table.columns.end())
      table.columns.push_back(column);
    const std::string sun = formatted("%g", p.place.sun_deg);
    if (table.rows.empty() || table.rows.back().what != sun) table.rows.push_back({sun, {}});
    table.rows.back().cells.push_back(
        SkyCell{mag_of_sunlit(p.cd_per_m2 / sunlight_lx),
                mag_of_sunlit(day_sky(clear_air(), {p.place.altitude_deg, p.place.azimuth_deg},
                                      p.place.sun_deg))});
  }
  return table;
}

}  // namespace

std::vector<SkyTable> day_sky_tables() {
  return {day_of_standards(), day_at_the_zenith(), day_of_a_model()};
}

}  // namespace dmise
