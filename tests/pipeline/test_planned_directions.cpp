#include <algorithm>
#include <cmath>
#include <random>

#include "tests/pipeline/harness.h"
#include "tests/pipeline/sky_targets.h"

// Directions measured in frames from which a plan, or the scenario, leaves effects of place out,
// against exact truth: a tracker takes each at its covariance.
namespace dmise {
namespace {

const Site chile{-30.17, -70.8, 2200.0};
const std::string evening = "2018-01-21T01:05:00Z";  // the Sun 15 deg down

/// Bright ones around the zenith.
std::vector<test::SkyTarget> targets(int count) {
  std::mt19937_64 random(7);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * double(random() >> 11) * 0x1p-53;
  };
  std::vector<test::SkyTarget> out;
  for (int i = 0; i < count; ++i) {
    test::SkyTarget t;
    t.azimuth_rad = uniform(0, 2 * pi);
    t.elevation_rad = pi / 2 - 26 * deg * std::sqrt(uniform(0, 1));
    t.altitude_m = std::exp(uniform(std::log(500e3), std::log(2000e3)));
    t.course_rad = uniform(0, 2 * pi);
    t.magnitude = uniform(0, 2);
    out.push_back(t);
  }
  return out;
}

struct Case {
  const char* name;
  bool stars;             // in the catalogue
  const char* sensor;     // more of its keys
  bool aberrated = true;  // the stars of its frames
};

/// 60 deg wide, 420 arcsec a pixel: 20 arcsec are 0.05 px.
std::string scenario(const Case& c) {
  return "simulation: {start: " + evening + ", duration_s: 10, tick_s: 2}\n" +
         (c.stars ? "stars: {catalogue: kstars}\n" : "") + "objects:\n" +
         test::own_objects(targets(40), chile, evening) +
         "sensors:\n"
         "  - name: wide\n"
         "    site: {latitude_deg: -30.17, longitude_deg: -70.8, height_m: 2200}\n"
         "    camera:\n"
         "      optics: {columns: 512, rows: 512, pixel_pitch_m: 9e-6, field_of_view_deg: 60,"
         " aperture_m: 5e-3, psf_fwhm_px: 1.8}\n"
         "      detector: {quantum_efficiency: 0.8, read_noise_e: 5, full_well_e: 100000,"
         " gain_e_per_dn: 1.6, bias_dn: 100, adc_bits: 16}\n"
         "      band: {name: V, centre_m: 0.55e-6, width_m: 0.09e-6}\n"
         "    pointing: zenith\n"
         "    exposure_s: 4\n"
         "    cadence_s: 10\n"
         "    sky: dark\n" +
         c.sensor;
}

/// Errors of a direction [arcsec], and their square by the published covariance per degree of
/// freedom.
struct Error {
  double east = 0.0, north = 0.0, nees = 0.0;
};

Error error_of(const Detection& d, const Truth& truth) {
  const double e =
      std::remainder(d.corrected_ra_rad - truth.true_ra_rad, 2 * pi) * std::cos(truth.true_dec_rad);
  const double n = d.corrected_dec_rad - truth.true_dec_rad;
  const auto [ee, en, nn] = d.covariance_rad2;
  return {e / arcsec, n / arcsec,
          (e * e * nn - 2 * e * n * en + n * n * ee) / (ee * nn - en * en) / 2};
}

struct PlannedDirections : testing::TestWithParam<Case> {};

TEST_P(PlannedDirections, AreWithinTheirCovariance) {
  test::Stage stage(scenario(GetParam()));
  const auto frame = stage.frame();
  EXPECT_EQ(norm(frame.header.earth_velocity_m_per_s) > 0, GetParam().aberrated);
  double nees = 0.0, east = 0.0, north = 0.0;
  int found = 0;
  for (const Truth& t : frame.truths)
    for (const Detection& d : frame.detections) {
      if (t.name[0] != 't' || d.at_edge || d.saturated ||
          std::hypot(d.x_px - t.rendered_x_px, d.y_px - t.rendered_y_px) > 0.1)
        continue;
      const Error error = error_of(d, t);
      nees += error.nees;
      east += error.east;
      north += error.north;
      ++found;
    }
  RecordProperty("found", found);
  RecordProperty("mean_nees", std::to_string(nees / found));
  RecordProperty("mean_east_arcsec", std::to_string(east / found));
  RecordProperty("mean_north_arcsec", std::to_string(north / found));
  EXPECT_GE(found, 20);
  EXPECT_LT(nees / found, 1.5);
  // Annual aberration is 20 arcsec in one direction for all.
  EXPECT_LT(std::hypot(east, north) / found, 3.0);
}

INSTANTIATE_TEST_SUITE_P(
    OfAWideCamera, PlannedDirections,
    testing::Values(
        Case{"no_star", false, "accuracy: standard\n", false},
        Case{"no_star_draft", false, "accuracy: draft\n", false},
        Case{"stars", true, "accuracy: standard\n", true}, Case{"reference", true, "", true},
        Case{"no_annual_aberration", true, "    effects: {annual_aberration: off}\n", false},
        Case{"no_diurnal_aberration", true, "    effects: {diurnal_aberration: off}\n", true},
        Case{"no_refraction", true, "    effects: {refraction: off}\n", true}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace dmise
