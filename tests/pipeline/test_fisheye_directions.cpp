#include <algorithm>
#include <cmath>
#include <random>

#include "tests/pipeline/harness.h"
#include "tests/pipeline/sky_targets.h"

// Directions of what crosses the sky of a fisheye, down to the horizon, against exact truth.
namespace dmise {
namespace {

const Site chile{-30.17, -70.8, 2200.0};
const std::string evening = "2018-01-21T01:05:00Z";  // the Sun 15 deg down

/// Evenly over the sky's disc as the camera images it, from 3 deg of elevation to the zenith.
std::vector<test::SkyTarget> targets_all_over(int count, unsigned seed, double brightest) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * double(random() >> 11) * 0x1p-53;
  };
  std::vector<test::SkyTarget> out;
  for (int i = 0; i < count; ++i) {
    test::SkyTarget t;
    t.azimuth_rad = uniform(0, 2 * pi);
    t.elevation_rad = pi / 2 - 87 * deg * std::sqrt(uniform(0, 1));
    t.altitude_m = std::exp(uniform(std::log(500e3), std::log(2000e3)));
    t.course_rad = uniform(0, 2 * pi);
    t.magnitude = uniform(brightest, brightest + 3);
    out.push_back(t);
  }
  return out;
}

std::string fisheye(const std::string& projection, const std::string& stars, unsigned seed,
                    double brightest) {
  return "simulation: {start: " + evening +
         ", duration_s: 20, tick_s: 2}\nstars: {catalogue: " + stars + "}\nobjects:\n" +
         test::own_objects(targets_all_over(60, seed, brightest), chile, evening) +
         "sensors:\n"
         "  - name: fish\n"
         "    site: {latitude_deg: -30.17, longitude_deg: -70.8, height_m: 2200}\n"
         "    camera:\n"
         "      optics: {projection: " +
         projection +
         ", columns: 1024, rows: 1024, pixel_pitch_m: 9e-6, field_of_view_deg: 180,"
         " aperture_m: 4e-3, psf_fwhm_px: 1.8, transmission: 0.8}\n"
         "      detector: {quantum_efficiency: 0.8, dark_e_per_s: 0.05, read_noise_e: 5,"
         " full_well_e: 100000, gain_e_per_dn: 1.6, bias_dn: 100, adc_bits: 16}\n"
         "      band: {name: V, centre_m: 0.55e-6, width_m: 0.09e-6}\n"
         "    pointing: zenith\n"
         "    exposure_s: 8\n"
         "    cadence_s: 20\n"
         "    sky: dark\n";
}

/// Squared error of the direction by the published covariance, per degree of freedom.
double nees(const Detection& d, const Truth& truth) {
  const double e =
      std::remainder(d.corrected_ra_rad - truth.true_ra_rad, 2 * pi) * std::cos(truth.true_dec_rad);
  const double n = d.corrected_dec_rad - truth.true_dec_rad;
  const auto [ee, en, nn] = d.covariance_rad2;
  return (e * e * nn - 2 * e * n * en + n * n * ee) / (ee * nn - en * en) / 2;
}

double length_px(const Truth& t) {
  return std::hypot(t.end_x_px - t.start_x_px, t.end_y_px - t.start_y_px);
}

/// With light enough for a detection and nothing else's light on it.
std::vector<Truth> lone_targets(const std::vector<Truth>& all) {
  std::vector<Truth> lit, out;
  for (const Truth& t : all)
    if (t.name[0] == 't' && t.in_frame && t.rendered_signal_e > 3000) lit.push_back(t);
  for (const Truth& t : lit) {
    const auto near = std::count_if(lit.begin(), lit.end(), [&](const Truth& o) {
      return std::hypot(o.rendered_x_px - t.rendered_x_px, o.rendered_y_px - t.rendered_y_px) <
             (length_px(o) + length_px(t)) / 2 + 10;
    });
    if (near == 1) out.push_back(t);  // itself
  }
  return out;
}

struct Judged {
  double elevation_rad = 0.0, nees = 0.0;
};

std::vector<Judged> judged_directions(const char* projection, unsigned scenes,
                                      double brightest = 1.0) {
  std::vector<Judged> out;
  for (unsigned seed = 1; seed <= scenes; ++seed) {
    test::Stage stage(fisheye(projection, "stars.csv", seed, brightest),
                      "ra_deg,dec_deg,mag_v\n0,89,6\n");
    const auto frame = stage.frame();
    for (const Truth& t : lone_targets(frame.truths))
      for (const Detection& d : frame.detections)
        if (std::hypot(d.x_px - t.rendered_x_px, d.y_px - t.rendered_y_px) < 1)
          out.push_back({t.true_elevation_rad, nees(d, t)});
  }
  return out;
}

struct FisheyeDirections : testing::TestWithParam<const char*> {};

// Two degrees of freedom: 98.9 % of all lie within 3 sigma.
TEST_P(FisheyeDirections, AreWithinTheirCovarianceFromTheHorizonToTheZenith) {
  const auto all = judged_directions(GetParam(), 8);
  double mean = 0.0, lowest = pi / 2;
  std::size_t within = 0;
  for (const Judged& j : all) {
    mean += j.nees / double(all.size());
    within += 2 * j.nees < 9;
    lowest = std::min(lowest, j.elevation_rad);
  }
  RecordProperty("found", int(all.size()));
  RecordProperty("mean_nees", std::to_string(mean));
  RecordProperty("within_3_sigma", std::to_string(double(within) / double(all.size())));
  RecordProperty("lowest_deg", std::to_string(lowest / deg));
  EXPECT_GE(all.size(), 200u);
  EXPECT_LT(lowest, 10 * deg);
  EXPECT_GT(mean, 0.5);
  EXPECT_LT(mean, 1.5);
  EXPECT_GE(double(within), 0.97 * double(all.size()));
}

// Streaks of less than 15 px are fitted as straight and even. In 8 s over a fisheye they bend by
// the projection, and change by a tenth in brightness with the distance and the air: each moves the
// place at mid exposure by several times the errors of bright ones.
TEST(FisheyeStreaks, BrightOnesTooShortToShowTheirBendAndSlopeAreWithinTheirCovariance) {
  const auto all = judged_directions("equidistant", 4, -2.0);
  double mean = 0.0;
  std::size_t within = 0;
  for (const Judged& j : all) {
    mean += j.nees / double(all.size());
    within += 2 * j.nees < 9;
  }
  RecordProperty("found", int(all.size()));
  RecordProperty("mean_nees", std::to_string(mean));
  RecordProperty("within_3_sigma", std::to_string(double(within) / double(all.size())));
  EXPECT_GE(all.size(), 100u);
  EXPECT_LT(mean, 1.5);
  EXPECT_GE(double(within), 0.95 * double(all.size()));
}

INSTANTIATE_TEST_SUITE_P(Projections, FisheyeDirections,
                         testing::Values("equidistant", "equisolid"));

}  // namespace
}  // namespace dmise
