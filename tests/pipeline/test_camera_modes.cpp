#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/sensors/pointing_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "sensors/frame/sensor_evaluator.h"
#include "tests/pipeline/harness.h"

// A star or an object that stands, in mid exposure, where a camera of each mode must look by closed
// form: its light lies in the middle of the frame.
namespace dmise {
namespace {

constexpr double tolerance_px = 0.01;
constexpr double middle_s = 2.5;

/// Nothing that moves a direction; no noise.
const std::string plain =
    "effects: {sky: off, photon_noise: off, dark_current: off, read_noise: off, full_well: off,"
    " quantisation: off, annual_aberration: off, diurnal_aberration: off, light_deflection: off,"
    " light_time: off, refraction: off, extinction: off, scintillation: off, clouds: off,"
    " earth_occultation: off, shadow: off}\n";

const std::string orbit =
    "objects:\n"
    "  - name: platform\n"
    "    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6,"
    " raan_deg: 0, true_anomaly_deg: 0}}\n"
    "    attitude: nadir\n";
/// Above Atlanta's zenith, turning with the Earth.
const std::string overhead =
    "objects:\n"
    "  - name: overhead\n"
    "    motion: {fixed: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 2000000}}\n"
    "    radius_m: 1\n";

std::string scenario(const std::string& objects, const std::string& place,
                     const std::string& pointing, double exposure_s) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5}\n" + objects +
         "stars: {catalogue: stars.csv, faintest_mag: 15}\n" + plain +
         "sensors:\n  - {name: eye, " + place + ", camera: raven, pointing: " + pointing +
         ", exposure_s: " + std::to_string(exposure_s) +
         ", cadence_s: 5, first_exposure_s: " + std::to_string(middle_s - exposure_s / 2) + "}\n";
}

std::string stars(std::initializer_list<Vec<Gcrs>> directions) {
  std::string csv = "ra_deg,dec_deg,mag_v,bv,parallax_mas,pm_ra_mas_per_yr,pm_dec_mas_per_yr\n";
  for (const auto& direction : directions) {
    const auto [ra, dec] = to_spherical(direction);
    char line[128];
    std::snprintf(line, sizeof line, "%.10f,%.10f,8,0.5,0,0,0\n", ra / deg, dec / deg);
    csv += line;
  }
  return csv;
}

/// Light around a place of the frame, from its middle.
void expect_light_at(test::Stage& stage, double right_px, double up_px) {
  const auto frame = stage.frame();
  const PixelPosition at{(frame.counts.columns - 1) / 2.0 + right_px,
                         (frame.counts.rows - 1) / 2.0 - up_px};
  const auto found = test::centroid(frame.counts, at, 60);
  EXPECT_NEAR(found.x_px, at.x_px, tolerance_px);
  EXPECT_NEAR(found.y_px, at.y_px, tolerance_px);
}

TEST(CameraModes, RatesInRightAscensionAndDeclination) {
  test::Stage stage(
      scenario(
          orbit, "platform: platform",
          "{ra_deg: 359.999, dec_deg: 20, ra_rate_deg_per_s: 0.004, dec_rate_deg_per_s: -0.002}",
          1.0),
      stars({from_spherical<Gcrs>((359.999 + 0.004 * middle_s) * deg,
                                  (20 - 0.002 * middle_s) * deg)}));
  expect_light_at(stage, 0, 0);
}

TEST(CameraModes, RatesInAzimuthAndElevation) {
  test::Stage stage(scenario(overhead, "site: atlanta",
                             "{azimuth_deg: 180, elevation_deg: 89.99, elevation_rate_deg_per_s: "
                             "0.004}",
                             1.0),
                    stars({{0, 0, -1}}));
  expect_light_at(stage, 0, 0);
}

// A nadir attitude: z down, x forward. A camera that looks along -z with x for up sees the zenith
// in the middle, and what lies ahead above.
TEST(CameraModes, FixedToTheBodyOfItsPlatform) {
  const double u = std::sqrt(3.986004418e14 / std::pow(7178137.0, 3)) * middle_s;
  const double ci = std::cos(98.6 * deg), si = std::sin(98.6 * deg);
  const Vec<Gcrs> zenith{std::cos(u), std::sin(u) * ci, std::sin(u) * si};
  const Vec<Gcrs> forward{-std::sin(u), std::cos(u) * ci, std::cos(u) * si};
  const double ahead_rad = 0.1 * deg;
  for (const std::string body :
       {"{body: {boresight: [0, 0, -1], up: [1, 0, 0]}}",
        // x right = -y, y down = -x, z = -z of the body: half a turn about (1, -1, 0).
        "{body: {body_from_camera: [0, 0.70710678118654752, -0.70710678118654752, 0]}}"}) {
    test::Stage stage(scenario(orbit, "platform: platform", body, 0.1),
                      stars({zenith * std::cos(ahead_rad) + forward * std::sin(ahead_rad)}));
    const auto& optics = stage.scenario.sensors[0].camera.optics;
    expect_light_at(stage, 0, std::tan(ahead_rad) * optics.focal_length_px());
  }
}

TEST(CameraModes, ScanningAboutAnAxisAmongTheStars) {
  test::Stage stage(scenario(orbit, "platform: platform",
                             "{scan: {ra_deg: 30, dec_deg: 40, axis: [0, 0, 2], rate_deg_per_s: "
                             "0.5}}",
                             0.05),
                    stars({from_spherical<Gcrs>((30 + 0.5 * middle_s) * deg, 40 * deg)}));
  expect_light_at(stage, 0, 0);
}

// From 10 deg south of the zenith up to it, about the axis that points west.
TEST(CameraModes, ScanningAboutAnAxisFixedToTheGround) {
  test::Stage stage(scenario(overhead, "site: atlanta",
                             "{scan: {azimuth_deg: 180, elevation_deg: 80, axis: [-1, 0, 0], "
                             "rate_deg_per_s: 4}}",
                             0.01),
                    stars({{0, 0, -1}}));
  expect_light_at(stage, 0, 0);
}

// Stepping and staring: between exposures it moves, during them stars are points.
TEST(CameraModes, AScanMayStandStillWhileTheShutterIsOpen) {
  test::Stage stage(scenario(orbit, "platform: platform",
                             "{scan: {ra_deg: 30, dec_deg: 40, axis: [0, 0, 1], rate_deg_per_s: "
                             "0.5}, tracking: sidereal}",
                             1.0),
                    stars({from_spherical<Gcrs>((30 + 0.5 * middle_s) * deg, 40 * deg)}));
  expect_light_at(stage, 0, 0);
}

TEST(CameraModes, WhatCannotBeIsNamed) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"{body: {boresight: [0, 0, 0]}}", "s.yaml:1:20: body.boresight: must not be zero"},
      {"{body: {boresight: [0, 0, 1], up: [0, 0, 2]}}",
       "s.yaml:1:35: body.up: must not be along boresight"},
      {"{body: {body_from_camera: [3, 0, 0, 0]}}", "body.body_from_camera"},
      {"{body: {up: [0, 0, 1]}}", "body: give either boresight (and up) or body_from_camera"},
      {"{body: {boresight: [0, 0, 1]}, roll_deg: 3}",
       "roll_deg: a camera fixed to a body is rolled by up"},
      {"{scan: {ra_deg: 3, dec_deg: 4, rate_deg_per_s: 1}}", "scan.axis"},
      {"{scan: {ra_deg: 3, dec_deg: 4, axis: [1, 0, 0]}}", "scan.rate_deg_per_s"},
      {"{scan: {azimuth_deg: 3, elevation_deg: 4, axis: [1, 0, 0], rate_deg_per_s: 1}}",
       "scan: azimuth and elevation are for a sensor on the ground"},
      {"{ra_deg: 1, dec_deg: 2, ra_rate_deg_per_s: .nan}", "ra_rate_deg_per_s"},
      {"{ra_deg: 1, dec_deg: 2, tracking: moving}", "needs a moving pointing: rates or scan"},
      {"{ra_deg: 1, dec_deg: 2, target: x}",
       "give one of azimuth_deg and elevation_deg, ra_deg and dec_deg, target, body, scan"}};
  for (const auto& [text, message] : cases) {
    SensorConfig sensor;
    try {
      read_pointing(YamlValue::parse(text, "s.yaml"), false, sensor);
      ADD_FAILURE() << text;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
  }
  SensorConfig sensor;
  EXPECT_THROW(read_pointing(YamlValue::parse("{body: {boresight: [0, 0, 1]}}", "s"), true, sensor),
               ConfigError);
}

TEST(CameraModes, TurningByMoreThan10DegWithinAnExposureIsRefused) {
  EXPECT_THROW(test::Stage(scenario(orbit, "platform: platform",
                                    "{ra_deg: 30, dec_deg: 40, ra_rate_deg_per_s: 20}", 1.0),
                           stars({{0, 0, 1}})),
               ConfigError);
}

TEST(CameraModes, ABodyWithoutAnAttitudeIsNamed) {
  const std::string bare = orbit.substr(0, orbit.find("    attitude"));
  std::string yaml = scenario(bare, "platform: platform", "{ra_deg: 0, dec_deg: 0}", 0.1);
  test::Stage stage(yaml, stars({{0, 0, 1}}));
  stage.scenario.sensors[0].pointing = PointBody{};
  const Clock clock = make_clock(stage.scenario);
  const OrbitActor actor(stage.scenario, clock, stage.threads);
  try {
    check_sensors(stage.scenario, actor.roster());
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find(
                  "sensors[0].pointing.body: the platform must be an object with an attitude, got "
                  "platform"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace dmise
