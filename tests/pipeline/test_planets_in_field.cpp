#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/units.h"
#include "sensors/scene/seen_planet.h"
#include "tests/pipeline/body_scenes.h"

// Planets in frames. Their places and magnitudes are those of
// tests/reference/planets_end_to_end.py.
namespace dmise::test {
namespace {

const std::string boulder = "site: {latitude_deg: 40, longitude_deg: -105, height_m: 1600}";

/// The topocentric line by DE421 [km] and V.
struct PlanetRow {
  const char* middle;  // UTC of mid exposure, less half a second
  Vec<Gcrs> line_km;
  double v_mag;
};
const PlanetRow jupiter{"2022-09-26T06:59:59.5Z", {589986759, 39235601, -1227024}, -2.939};
const PlanetRow venus{"2020-05-20T02:44:59.5Z", {7785536, 42136788, 21391055}, -4.463};

std::string of_planet(const PlanetRow& row, double focal_m, const std::string& keys,
                      double exposure_s = 0.01, const std::string& world = "") {
  return scenario(row.middle, 5, boulder, camera(200, 200, focal_m), towards(row.line_km),
                  exposure_s, 5, keys, "", world);
}

/// 25 stars of V = 6 around a direction, in the field of a focal length.
std::string stars_around(const Vec<Gcrs>& direction, double focal_m) {
  const auto [ra, dec] = to_spherical(direction);
  const double wide = 0.2 / focal_m;
  std::string csv = "ra_deg,dec_deg,mag_v\n";
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      char line[96];
      std::snprintf(line, sizeof line, "%.6f,%.6f,6\n",
                    ra / deg + (0.21 * i + 0.07) * wide / std::cos(dec),
                    dec / deg + (0.19 * j + 0.05) * wide);
      csv += line;
    }
  return csv;
}

const StarTruth* planet_in(const FrameProducts& frame) {
  const auto planet =
      std::ranges::find_if(frame.stars, [](const StarTruth& star) { return star.id & planet_bit; });
  return planet == frame.stars.end() ? nullptr : &*planet;
}

// The pointing is astrometric; aberration and refraction of a planet are those of the stars there.
TEST(PlanetsInField, AreInTheMiddleOfACameraThatPointsAtThem) {
  for (const PlanetRow& row : {jupiter, venus})
    for (const double focal_m : {0.2, 2.0}) {
      // A disc has as much light in a pixel as the point, and its field is smaller than refraction.
      // Venus stands in twilight.
      Stage stage(of_planet(
          row, focal_m, more(", extinction: off, refraction: off, twilight: off, daylight: off"),
          focal_m > 1.0 ? 1.0 : 0.01));
      const FrameProducts frame = stage.frame();
      const StarTruth* planet = planet_in(frame);
      ASSERT_TRUE(planet);
      // In the frame's own WCS the planet is where the ephemeris has it, but for its phase.
      const auto middle = wcs_pixel(frame.header.wcs, unit(row.line_km));
      ASSERT_TRUE(middle);
      const double phase_px = row.line_km == venus.line_km ? 25 * arcsec / (1e-5 / focal_m) : 0.0;
      EXPECT_LT(std::hypot(planet->x_px - middle->x_px, planet->y_px - middle->y_px),
                phase_px + 0.5 * arcsec / (1e-5 / focal_m) + 0.01);
      EXPECT_NEAR(planet->v_mag, row.v_mag, 0.04);  // skyfield's Sun is the barycentre: 0.03 mag
      double light_e = 0.0;
      for (const auto count : frame.counts.pixels) light_e += count;
      EXPECT_NEAR(light_e / planet->signal_e, 1.0, 0.01)
          << row.middle << ' ' << focal_m << " m: " << light_e << " e";
    }
}

TEST(PlanetsInField, AreNotThereWhereTheyAreSwitchedOffOrBesideTheFrame) {
  Stage off(of_planet(jupiter, 0.2, more(", planets: off")));
  const auto without = off.frame();
  EXPECT_FALSE(planet_in(without));
  EXPECT_EQ(without.report.plan.find("planets"), std::string::npos);
  Stage beside(scenario(jupiter.middle, 5, boulder, camera(200, 200, 2.0),
                        towards(unit(jupiter.line_km) + Vec<Gcrs>{0, 0, 0.01}), 0.01, 5, more()));
  EXPECT_FALSE(planet_in(beside.frame()));
  EXPECT_EQ(beside.frame().report.plan.find("planets"), std::string::npos);
}

// Without any star annual aberration still displaces a planet: 20 arcsec are 4 px here.
TEST(PlanetsInField, APlanKeepsTheAberrationOfAPlanetWithoutStars) {
  Stage exact(of_planet(jupiter, 0.4, more()));
  Stage planned(of_planet(jupiter, 0.4, more()) + "accuracy: standard\n");
  const FrameProducts a = exact.frame(), b = planned.frame();
  ASSERT_TRUE(planet_in(a) && planet_in(b));
  EXPECT_NEAR(planet_in(a)->x_px, planet_in(b)->x_px, 0.05);
  EXPECT_NEAR(planet_in(a)->y_px, planet_in(b)->y_px, 0.05);
}

TEST(PlanetsInField, DetectionWithACatalogueKnowsThem) {
  for (const double focal_m : {0.2, 0.8}) {
    Stage stage(
        of_planet(jupiter, focal_m, ", sky: dark, effects: {scintillation: off}", 1.0, with_stars),
        stars_around(jupiter.line_km, focal_m));
    const FrameProducts frame = stage.frame();
    EXPECT_TRUE(planet_in(frame));
    EXPECT_GT(frame.report.stars_found, 0u);
    EXPECT_TRUE(frame.detections.empty());
  }
}

}  // namespace
}  // namespace dmise::test
