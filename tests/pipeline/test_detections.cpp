#include <algorithm>
#include <cmath>
#include <random>

#include "core/wcs/wcs.h"
#include "tests/pipeline/harness.h"
#include "tests/pipeline/sky_targets.h"

// What detections claim of themselves, drawn and found by the pipeline, against exact truth.
namespace dmise {
namespace {

// A mountain in Chile, an hour after sunset: the Sun 15 deg down.
const Site chile{-30.17, -70.8, 2200.0};
const std::string evening = "2018-01-21T01:05:00Z";

/// A quarter of the raven's frame: the same optics and pixels.
std::string camera_file(
    const std::string& psf = "psf_fwhm_px: 1.6", const std::string& blooming = "false",
    const std::string& band = "{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}") {
  const auto path = std::filesystem::path(testing::TempDir()) / "telescope-0.4m.yaml";
  std::ofstream(path)
      << "name: telescope-0.4m\n"
         "optics: {columns: 512, rows: 512, pixel_pitch_m: 13.5e-6, "
         "focal_length_m: 1.2, aperture_m: 0.4, obscuration: 0.4, "
         "transmission: 0.75, " +
             psf +
             "}\n"
             "detector: {quantum_efficiency: 0.90, dark_e_per_s: 0.1, read_noise_e: 8, "
             "full_well_e: 100000, gain_e_per_dn: 1.6, bias_dn: 300, adc_bits: 16, blooming: " +
             blooming +
             "}\n"
             "band: " +
             band + "\n";
  return path.string();
}

std::string scenario(const std::vector<test::SkyTarget>& targets, const std::string& sensor,
                     const std::string& camera = camera_file()) {
  std::string yaml = "simulation: {start: " + evening +
                     ", duration_s: 4, tick_s: 1}\nstars: {catalogue: stars.csv}\n"
                     "objects:\n" +
                     test::own_objects(targets, chile, evening) + "sensors:\n";
  for (std::size_t i = 0; i < targets.size(); ++i)
    yaml +=
        "- {name: s" + std::to_string(i) +
        ", site: {latitude_deg: -30.17, longitude_deg: -70.8, height_m: 2200}, camera: " + camera +
        ", pointing: {target: t" + std::to_string(i) + sensor + "}\n";
  return yaml;
}

const Truth* truth_of(const FrameProducts& frame, std::size_t target) {
  for (const Truth& t : frame.truths)
    if (t.name == "t" + std::to_string(target)) return &t;
  return nullptr;
}

/// Squared error of a direction by its covariance, per degree of freedom.
double nees(double east, double north, const std::array<double, 3>& covariance) {
  const auto [ee, en, nn] = covariance;
  return (east * east * nn - 2 * east * north * en + north * north * ee) / (ee * nn - en * en) / 2;
}

double nees(const Detection& d, const Truth& truth) {
  return nees(
      std::remainder(d.corrected_ra_rad - truth.true_ra_rad, 2 * pi) * std::cos(truth.true_dec_rad),
      d.corrected_dec_rad - truth.true_dec_rad, d.covariance_rad2);
}

struct Nees {
  double mean = 0.0, median = 0.0;  // per degree of freedom
  std::size_t found = 0;
};

/// NEES of the directions of the objects aimed at, by the published covariance.
Nees nees_of(test::Stage& stage) {
  std::vector<double> all;
  for (std::size_t k = 0; k < stage.scenario.sensors.size(); ++k) {
    const auto frame = stage.frame(1, k);
    const Truth* truth = truth_of(frame, k);
    if (!truth) continue;
    for (const Detection& d : frame.detections) {
      if (std::hypot(d.x_px - truth->rendered_x_px, d.y_px - truth->rendered_y_px) > 3) continue;
      all.push_back(nees(d, *truth));
    }
  }
  Nees out{.found = all.size()};
  if (all.empty()) return out;
  std::sort(all.begin(), all.end());
  for (const double v : all) out.mean += v / double(all.size());
  out.median = all[all.size() / 2];
  return out;
}

std::vector<test::SkyTarget> targets_between(double lowest_m, double highest_m, int count,
                                             unsigned seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * double(random() >> 11) * 0x1p-53;
  };
  std::vector<test::SkyTarget> out;
  for (int i = 0; i < count; ++i) {
    test::SkyTarget t;
    t.azimuth_rad = uniform(0, 2 * pi);
    t.elevation_rad = uniform(20 * deg, 80 * deg);
    t.altitude_m = std::exp(uniform(std::log(lowest_m), std::log(highest_m)));
    t.course_rad = uniform(0, 2 * pi);
    t.magnitude = uniform(9, 11);
    out.push_back(t);
  }
  return out;
}

const std::string stars = "ra_deg,dec_deg,mag_v\n0,89,6\n";

// The Sun's R in Vega and AB magnitudes, less its V of 4.81: 4.43 and 4.60 (Willmer 2018, ApJS 236,
// 47).
TEST(Magnitudes, ASourceOfTheSunsColourHasTheSunsColourInTheCamerasSystem) {
  const auto targets = targets_between(1000e3, 1000e3, 1, 8);
  double true_v = 0.0, v_solar = 0.0;
  for (const auto& [system, v_r, tolerance] :
       {std::tuple("V-solar", 0.0, 0.0), {"Vega", 0.38, 0.02}, {"AB", 0.21, 0.02}}) {
    const std::string camera = camera_file("psf_fwhm_px: 1.6", "false",
                                           "bessell-R\nmagnitude_system: " + std::string(system));
    test::Stage stage(scenario(targets, ", tracking: target}, exposure_s: 1, cadence_s: 2", camera),
                      stars);
    const auto frame = stage.frame(1, 0);
    ASSERT_EQ(frame.detections.size(), 1u) << system;
    const Detection& d = frame.detections[0];
    EXPECT_STREQ(magnitude_system_name(d.magnitude_system), system);
    EXPECT_EQ(frame.report.magnitudes, frame.header.magnitudes);
    if (tolerance == 0.0) {
      v_solar = d.magnitude;
      true_v = frame.truths.at(0).true_magnitude;
      EXPECT_NEAR(v_solar, true_v, 0.02 + 3 * d.magnitude_sigma);
    }
    EXPECT_NEAR(d.magnitude, v_solar - v_r, tolerance) << system;
  }
}

class DirectionNees : public testing::Test {
 protected:
  static void expect_honest(const std::vector<test::SkyTarget>& targets, const char* sensor) {
    test::Stage stage(scenario(targets, sensor), stars);
    const Nees found = nees_of(stage);
    RecordProperty("mean", std::to_string(found.mean));
    RecordProperty("median", std::to_string(found.median));
    EXPECT_GE(found.found, 200u);
    EXPECT_GT(found.mean, 0.8);
    EXPECT_LT(found.mean, 1.2);
  }
};

// Altitudes evenly spread in their logarithm from 300 km to GEO, as the covariance takes them.
TEST_F(DirectionNees, OfPointsFromLowToGeostationaryOrbits) {
  expect_honest(targets_between(300e3, 35786e3, 300, 1),
                ", tracking: target}, exposure_s: 1, cadence_s: 2");
}

// As most of a catalogue is.
TEST_F(DirectionNees, OfPointsInLowOrbits) {
  expect_honest(targets_between(400e3, 1500e3, 420, 2),
                ", tracking: target}, exposure_s: 0.25, cadence_s: 2");
}

// Nothing of refraction is left where there is no air, or the scenario says so; on the ground a
// part is, of known length and unknown angle. Light is lifted towards the zenith: the line of sight
// passes above the sensor, 2.3 m tan z / cos z in first order at sea level (refractivity 2.77e-4
// times a scale height of 8.4 km), three quarters of it at 2200 m.
TEST(DetectionFlags, RefractionIsRemovedWhereThereIsNone) {
  const auto targets = targets_between(1000e3, 1000e3, 1, 8);
  const std::string sensor = ", tracking: target}, exposure_s: 1, cadence_s: 2";
  test::Stage ground(scenario(targets, sensor), stars);
  const auto with = ground.frame(1, 0);
  ASSERT_EQ(with.detections.size(), 1u);
  const Detection& d = with.detections[0];
  EXPECT_FALSE(d.refraction_removed);
  const double z = pi / 2 - truth_of(with, 0)->true_elevation_rad;
  EXPECT_NEAR(norm(d.refraction_offset_m), 0.77 * 2.33 * std::tan(z) / std::cos(z),
              0.05 * norm(d.refraction_offset_m));
  EXPECT_GT(dot(d.refraction_offset_m, d.sensor_position_m), 0.0);
  EXPECT_NEAR(dot(d.refraction_offset_m, from_spherical<Gcrs>(d.ra_rad, d.dec_rad)), 0.0, 1e-9);
  EXPECT_FALSE(d.saturated || d.at_edge || d.star_like || d.direction_known);
  test::Stage off(scenario(targets, sensor + ", effects: {refraction: off}"), stars);
  const auto without = off.frame(1, 0);
  ASSERT_EQ(without.detections.size(), 1u);
  EXPECT_TRUE(without.detections[0].refraction_removed);
  EXPECT_EQ(norm(without.detections[0].refraction_offset_m), 0.0);
  EXPECT_EQ(without.detections[0].refraction_parallax_sigma_rad, 0.0);
}

// OSCAR 7 as in `catalogue: demo`: a sphere of 1 m at 1460 km, V = 7.7, whose light fills the
// wells of one to three pixels of the raven in a second, by where in a pixel it falls.
TEST(SaturatedPoint, IsFoundInEveryFrameAndFlagged) {
  test::Stage stage(
      "simulation: {start: 2018-02-09T10:15:40Z, duration_s: 45, tick_s: 5}\n"
      "objects: [{catalogue: objects.tle, radius_m: 0.74}]\nstars: {catalogue: kstars}\n"
      "sensors:\n  - {name: raven, site: atlanta, camera: raven, pointing: {target: \"7530\"}, "
      "exposure_s: 1, cadence_s: 2}\n",
      "",
      "OSCAR 7\n"
      "1 07530U 74089B   18020.92882759 -.00000031  00000-0  83259-4 0  9990\n"
      "2 07530 101.6660 350.5859 0011799 260.7489 115.8236 12.53630761975916\n");
  int below = 0;
  for (std::uint32_t number = 1; number <= 20; ++number) {
    const auto frame = stage.frame(number);
    // Wells are read with noise: not every full one shows the highest count.
    const auto highest = *std::max_element(frame.counts.pixels.begin(), frame.counts.pixels.end());
    below += highest < frame.header.saturation_dn;
    ASSERT_EQ(frame.detections.size(), 1u) << number;
    const Detection& d = frame.detections[0];
    EXPECT_TRUE(d.saturated) << number;
    EXPECT_GT(frame.report.saturated_px, 0u) << number;
    EXPECT_EQ(d.kind, DetectionKind::point) << number;
    EXPECT_NEAR(d.x_px, frame.truths.at(0).rendered_x_px, 0.05) << number;
    EXPECT_NEAR(d.y_px, frame.truths.at(0).rendered_y_px, 0.05) << number;
  }
  RecordProperty("below_saturate", below);
}

struct SaturatedTargets : testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(SaturatedTargets, AreFoundFlaggedAndTheirCovarianceIsHonest) {
  const auto [psf, blooming] = GetParam();
  auto targets = targets_between(500e3, 35786e3, 60, 5);
  for (std::size_t i = 0; i < targets.size(); ++i) targets[i].magnitude = 4 + 0.06 * double(i);
  test::Stage stage(scenario(targets, ", tracking: target}, exposure_s: 1, cadence_s: 2",
                             camera_file(psf, blooming)),
                    stars);
  double place = 0.0, light = 0.0;
  int saturated = 0, flagged = 0;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto frame = stage.frame(1, k);
    const Truth* truth = truth_of(frame, k);
    if (!truth || truth->rendered_signal_e < 1e5) continue;  // in the Earth's shadow
    saturated += frame.report.saturated_px > 0;
    ASSERT_LE(frame.detections.size(), 1u) << k;
    for (const Detection& d : frame.detections) {
      EXPECT_EQ(d.saturated, frame.report.saturated_px > 0) << k;
      if (!d.saturated) continue;
      ++flagged;
      const double dx = d.x_px - truth->rendered_x_px, dy = d.y_px - truth->rendered_y_px;
      const auto [xx, xy, yy] = d.covariance_px2;
      place += (dx * dx * yy - 2 * dx * dy * xy + dy * dy * xx) / (xx * yy - xy * xy) / 2;
      light +=
          std::pow(2.5 * std::log10(d.signal_e / truth->rendered_signal_e) / d.magnitude_sigma, 2);
    }
  }
  RecordProperty("saturated", saturated);
  RecordProperty("found", flagged);
  RecordProperty("nees_place", std::to_string(place / flagged));
  RecordProperty("nees_light", std::to_string(light / flagged));
  EXPECT_GE(saturated, 20);
  EXPECT_EQ(flagged, saturated);
  EXPECT_LT(place / flagged, 1.2);
  EXPECT_LT(light / flagged, 1.2);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, SaturatedTargets,
                         testing::Combine(testing::Values("psf_fwhm_px: 1.6", "psf_fwhm_px: 4"),
                                          testing::Values("false")));

/// NEES of both ends, in any order, against where the pixels of start and end are in the sky.
double nees_of_ends(const Detection& d, const Truth& truth, const Wcs& wcs) {
  PixelPosition at1{truth.start_x_px, truth.start_y_px}, at2{truth.end_x_px, truth.end_y_px};
  if (at2.x_px < at1.x_px) std::swap(at1, at2);
  const auto one = [&](double ra, double dec, const std::array<double, 3>& covariance,
                       PixelPosition at) {
    const auto place = to_spherical(wcs_direction(wcs, at));
    return nees(std::remainder(ra - place[0], 2 * pi) * std::cos(place[1]), dec - place[1],
                covariance);
  };
  return (one(d.end1_ra_rad, d.end1_dec_rad, d.end1_covariance_rad2, at1) +
          one(d.end2_ra_rad, d.end2_dec_rad, d.end2_covariance_rad2, at2)) /
         2;
}

/// Fixed to the ground, 33 deg across: 250 arcsec a pixel.
std::string wide_camera() {
  const auto path = std::filesystem::path(testing::TempDir()) / "wide.yaml";
  std::ofstream(path) << "name: wide\noptics: {columns: 480, rows: 480, pixel_pitch_m: 10.8e-6, "
                         "focal_length_m: 0.009, aperture_m: 0.004, psf_fwhm_px: 1.7}\n"
                         "detector: {quantum_efficiency: 0.6, read_noise_e: 8, full_well_e: "
                         "100000, gain_e_per_dn: 1.6, bias_dn: 300, adc_bits: 16}\n"
                         "band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}\n";
  return path.string();
}

// Low orbits through a wide camera: arcs whose middle is up to half a degree from where the object
// was at mid exposure, their centroid of light as far again, and off the bent line. Radial speeds
// as the covariance takes them.
TEST(StreakNees, OfStreaksOfTenDegrees) {
  auto targets = targets_between(400e3, 1500e3, 110, 3);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (auto& t : targets) {
    t.elevation_rad = 35 * deg + 0.6 * (t.elevation_rad - 20 * deg);
    t.magnitude = -1;
    t.radial_share = 0.02 * normal(random);
  }
  std::string yaml = "simulation: {start: " + evening +
                     ", duration_s: 20, tick_s: 5}\nstars: {catalogue: stars.csv}\nobjects:\n" +
                     test::own_objects(targets, chile, evening) + "sensors:\n";
  const std::string camera = wide_camera();
  for (std::size_t i = 0; i < targets.size(); ++i)
    yaml +=
        "- {name: s" + std::to_string(i) +
        ", site: {latitude_deg: -30.17, longitude_deg: -70.8, height_m: 2200}, camera: " + camera +
        ", effects: {shadow: off}, pointing: {azimuth_deg: " +
        std::to_string(targets[i].azimuth_rad / deg) +
        ", elevation_deg: " + std::to_string(targets[i].elevation_rad / deg) +
        "}, exposure_s: 20, cadence_s: 20}\n";
  test::Stage stage(yaml, stars);
  double sum = 0.0, ends = 0.0, arcs_rad = 0.0;
  int found = 0;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto frame = stage.frame(1, k);
    const Truth* truth = truth_of(frame, k);
    if (!truth || !truth->whole) continue;
    for (const Detection& d : frame.detections) {
      // x_px, y_px are of the light, wherever the object was at mid exposure.
      const double off = std::hypot(d.x_px - truth->rendered_x_px, d.y_px - truth->rendered_y_px);
      if (off > 0.5 || d.at_edge || d.kind != DetectionKind::streak) continue;
      sum += nees(d, *truth);
      ends += nees_of_ends(d, *truth, frame.header.wcs);
      arcs_rad += d.rate_rad_per_s * 20;
      ++found;
    }
  }
  RecordProperty("found", found);
  RecordProperty("mean_arc_deg", std::to_string(arcs_rad / found / deg));
  RecordProperty("mean", std::to_string(sum / found));
  RecordProperty("ends", std::to_string(ends / found));
  EXPECT_GE(found, 80);
  EXPECT_NEAR(arcs_rad / found, 10 * deg, 3 * deg);
  EXPECT_GT(sum / found, 0.7);
  EXPECT_LT(sum / found, 1.3);
  EXPECT_GT(ends / found, 0.7);
  EXPECT_LT(ends / found, 1.3);
}

// Stars from V = 0 to 9: up to thousands of times what a well holds, none of them moves.
struct SaturatedStars : testing::TestWithParam<std::tuple<const char*, const char*, const char*>> {
};

TEST_P(SaturatedStars, AreNoDetections) {
  const auto [psf, blooming, motion] = GetParam();
  const std::string camera = camera_file(psf, blooming);
  std::string csv = "ra_deg,dec_deg,mag_v,bv\n";
  for (int i = 0; i < 100; ++i) {
    const int column = i % 10, row = i / 10;
    csv += std::to_string(120 + (column - 4.5) * 0.0317 + 0.0003 * i) + "," +
           std::to_string(-20 + (row - 4.5) * 0.0289) + "," + std::to_string(i % 19 * 0.5) +
           ",0.5\n";
  }
  test::Stage stage("simulation: {start: " + evening +
                        ", duration_s: 60, tick_s: 5}\nobjects: []\nstars: {catalogue: stars.csv}\n"
                        "sensors:\n- {name: s, site: {latitude_deg: -30.17, longitude_deg: -70.8, "
                        "height_m: 2200}, camera: " +
                        camera + ", pointing: {ra_deg: 120, dec_deg: -20" + motion + "}\n",
                    csv);
  std::size_t found = 0, saturated = 0;
  for (std::uint32_t number = 1; number <= 3; ++number) {
    const auto frame = stage.frame(number);
    found += frame.detections.size();
    saturated += frame.report.saturated_px;
  }
  EXPECT_GT(saturated, 300u);
  EXPECT_EQ(found, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Everywhere, SaturatedStars,
    testing::Combine(testing::Values("psf_fwhm_px: 1.6", "psf_fwhm_px: 4", "psf: diffraction"),
                     testing::Values("false", "true"),
                     testing::Values("}, exposure_s: 1, cadence_s: 5",
                                     ", tracking: fixed}, exposure_s: 0.3, cadence_s: 5",
                                     ", tracking: fixed}, exposure_s: 0.8, cadence_s: 5",
                                     ", tracking: fixed}, exposure_s: 4, cadence_s: 5")));

}  // namespace
}  // namespace dmise
