#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/units.h"
#include "core/wcs/wcs.h"
#include "sensors/planning/exposure_planner.h"
#include "tests/pipeline/harness.h"
#include "tests/sky/gcvs_rows.h"

// Frames whose stars have the brightness of the instant.
namespace dmise {
namespace {

/// A camera that follows a place among the stars; `stars`: more keys of them.
std::string variable_scenario(const std::string& start, const std::string& place,
                              const std::string& stars, const std::string& more = "") {
  return "simulation: {start: " + start +
         ", duration_s: 60, tick_s: 5}\n"
         "stars: {catalogue: stars.csv, faintest_mag: 13" +
         stars + "}\n" + more +
         "sensors:\n  - name: eye\n"
         "    site: {latitude_deg: 50, longitude_deg: 15, height_m: 300}\n"
         "    camera: {optics: {projection: gnomonic, columns: 256, rows: 256, "
         "pixel_pitch_m: 15e-6, focal_length_m: 0.88, aperture_m: 0.02, psf_fwhm_px: 2}, detector: "
         "{quantum_efficiency: 0.8, full_well_e: 1.0e+9, gain_e_per_dn: 1}, band: {name: V, "
         "centre_m: 0.55e-6, width_m: 0.09e-6}}\n"
         "    pointing: {" +
         place +
         ", tracking: sidereal}\n    sky: dark\n"
         "    exposure_s: 2\n    cadence_s: 60\n"
         "    effects: {photon_noise: off, read_noise: off, scintillation: off, extinction: off}\n";
}

/// A variable star in the middle of the field and one of V = 6 beside it, both of one colour.
std::string beside_constant(double ra_deg, double dec_deg, double v_mag) {
  const auto row = [](int id, double ra, double dec, double v) {
    return std::to_string(id) + "," + std::to_string(ra) + "," + std::to_string(dec) + "," +
           std::to_string(v) + ",0.65\n";
  };
  return "id,ra_deg,dec_deg,mag_v,bv\n" + row(1, ra_deg, dec_deg, v_mag) +
         row(2, ra_deg, dec_deg + 0.03, 6.0);
}

const StarTruth* star_of(const FrameProducts& frame, std::uint64_t id) {
  for (const StarTruth& star : frame.stars)
    if (star.id == id) return &star;
  return nullptr;
}

struct VariableFrame {
  const char* name;
  const char* start;  // a second before the middle of the frame
  double ra_deg, dec_deg, catalogue_v_mag, v_mag;
};

// Reference: tests/reference/variable_stars.py, 2018-08-15T21:44:10Z.
TEST(VariableFrames, HaveStarsOfTheBrightnessOfTheInstant) {
  const VariableFrame frames[] = {
      {"Algol in eclipse", "2018-08-15T21:44:09Z", 47.04221, 40.95561, 2.1, 2.4257},
      {"beta Lyrae", "2018-08-15T21:44:09Z", 282.52, 33.362694, 3.5, 3.6257},
      {"delta Cephei", "2018-08-15T21:44:09Z", 337.292792, 58.415194, 4.0, 3.7883},
      {"RR Lyrae", "2018-08-15T21:44:09Z", 291.366292, 42.784389, 7.7, 7.8604},
      {"W Ursae Majoris", "2018-08-15T21:44:09Z", 145.9395, 55.952500, 7.9, 8.0651}};
  for (const VariableFrame& f : frames) {
    test::Stage stage(variable_scenario(f.start,
                                        "ra_deg: " + std::to_string(f.ra_deg) +
                                            ", dec_deg: " + std::to_string(f.dec_deg),
                                        ", variables: gcvs.txt", "detection: off\n"),
                      beside_constant(f.ra_deg, f.dec_deg, f.catalogue_v_mag), "", 1,
                      test::gcvs_rows);
    const FrameProducts frame = stage.frame();
    const StarTruth *variable = star_of(frame, 1), *constant = star_of(frame, 2);
    ASSERT_TRUE(variable && constant) << f.name;
    EXPECT_NEAR(variable->v_mag, f.v_mag, 0.003) << f.name;
    const double ratio = std::pow(10.0, -0.4 * (f.v_mag - 6.0));
    EXPECT_NEAR(variable->signal_e / constant->signal_e / ratio, 1.0, 0.01) << f.name;
    // The light on the pixels is that of the truth.
    const auto counts_near = [&](const StarTruth& star) {
      double sum = 0.0;
      for (int y = -12; y <= 12; ++y)
        for (int x = -12; x <= 12; ++x)
          sum += frame.counts.at(int(star.x_px) + x, int(star.y_px) + y);
      return sum;
    };
    const double sky = counts_near({.x_px = 30.0, .y_px = 30.0});
    const double saturated = 25 * 65535.0;
    if (counts_near(*variable) < saturated) {
      EXPECT_NEAR((counts_near(*variable) - sky) / (counts_near(*constant) - sky) / ratio, 1.0,
                  0.03)
          << f.name;
    }
  }
}

TEST(VariableFrames, WithoutAVariableAreTheSameBytes) {
  const std::string place = "ra_deg: 95, dec_deg: 60";
  const std::string start = "2018-01-21T23:00:00Z";
  const std::string stars = "id,ra_deg,dec_deg,mag_v,bv\n1,95,60,9.2,0.65\n2,95.02,60.02,11,1.1\n";
  test::Stage with(variable_scenario(start, place, ", variables: gcvs.txt", "detection: off\n"),
                   stars, "", 1, test::gcvs_rows);
  test::Stage without(variable_scenario(start, place, "", "detection: off\n"), stars);
  EXPECT_EQ(with.frame().counts.pixels, without.frame().counts.pixels);
}

// What a plan leaves out is bounded by the brightest that a star may be, whatever it is now.
TEST(VariableFrames, ArePlannedByTheBrightestOfTheirStars) {
  // Mira at 9.44; the catalogue has 9.2, and its brightest is 2.0.
  const double ra_deg = 34.836583, dec_deg = -2.977611;
  const auto facts = [&](const std::string& variables) {
    test::Stage stage(
        variable_scenario("2018-08-15T21:44:09Z", "ra_deg: 34.836583, dec_deg: -2.977611",
                          variables, "accuracy: standard\n"),
        beside_constant(ra_deg, dec_deg, 9.2), "", 1, test::gcvs_rows);
    const SensorConfig& sensor = stage.scenario.sensors.at(0);
    const ExposurePlanner planner(sensor, stage.stars.get(), stage.scenario.faintest_star_mag,
                                  nullptr);
    return planner.facts(View(sensor, frame_times(sensor, 1), stage.states), {});
  };
  const PlanFacts constant = facts(""), variable = facts(", variables: gcvs.txt");
  EXPECT_NEAR(variable.brightest_star_e / constant.brightest_star_e, std::pow(10.0, 0.4 * 4.0),
              0.05 * std::pow(10.0, 0.4 * 4.0));  // V = 2 beside 6
  EXPECT_DOUBLE_EQ(variable.brightest_left_e[variable.limit(1)], variable.brightest_star_e);
}

// A star that is brighter than the catalogue's limit for an hour is drawn in that hour.
TEST(VariableFrames, HaveStarsBeyondTheCataloguesLimitWhileTheyAreBright) {
  const std::string place = "ra_deg: 34.836583, dec_deg: -2.977611";
  const auto mira = [&](const std::string& start, const std::string& variables) {
    std::string yaml = variable_scenario(start, place, variables, "detection: off\n");
    yaml.replace(yaml.find("faintest_mag: 13"), 16, "faintest_mag: 8 ");
    test::Stage stage(yaml, beside_constant(34.836583, -2.977611, 9.2), "", 1, test::gcvs_rows);
    const FrameProducts frame = stage.frame();
    const StarTruth* star = star_of(frame, 1);
    return star ? star->v_mag : std::numeric_limits<double>::infinity();
  };
  EXPECT_NEAR(mira("2018-11-30T16:04:59Z", ", variables: gcvs.txt"), 2.007, 0.01);
  EXPECT_GT(mira("2018-11-30T16:04:59Z", ""), 1e9);
}

}  // namespace
}  // namespace dmise
