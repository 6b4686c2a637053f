#include <erfa.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/sensors/camera_config.h"
#include "core/config/sensors/pointing_config.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/frames/geodesy.h"
#include "core/optics/projection.h"
#include "core/sky/places/place_effects.h"
#include "core/time/iso8601.h"
#include "sensors/frame/sensor_evaluator.h"
#include "sensors/scene/view.h"
#include "tests/pipeline/harness.h"

// A mount that points at an object has the object's light in the middle of its frame.
namespace dmise {
namespace {

constexpr double tolerance_px = 0.2;
constexpr double middle_s = 2.5;
constexpr double gm_m3_per_s2 = 3.986004418e14;
const char* const start = "2018-01-21T00:15:00Z";

/// Two-body motion through a place at mid exposure: on a circle, `heading_deg` from north to east.
std::string object_at(const std::string& name, const Vec<Gcrs>& place_m, double heading_deg) {
  const Vec<Gcrs> up = unit(place_m), east = unit(cross(Vec<Gcrs>{0, 0, 1}, up));
  const Vec<Gcrs> north = cross(up, east);
  const double speed = std::sqrt(gm_m3_per_s2 / norm(place_m));
  const Vec<Gcrs> v =
      (east * std::sin(heading_deg * deg) + north * std::cos(heading_deg * deg)) * speed;
  char text[512];
  std::snprintf(text, sizeof text,
                "  - name: %s\n    radius_m: 5\n    motion: {two_body: {epoch: "
                "2018-01-21T00:15:02.5Z, position_m: [%.6f, %.6f, %.6f], velocity_m_per_s: [%.9f, "
                "%.9f, %.9f]}}\n",
                name.c_str(), place_m.x, place_m.y, place_m.z, v.x, v.y, v.z);
  return text;
}

/// On the sphere of radius `orbit_m` about the Earth's centre, from a place along a direction.
Vec<Gcrs> on_orbit(const Vec<Gcrs>& from_m, const Vec<Gcrs>& along, double orbit_m) {
  const double b = dot(from_m, along);
  const double range_m = -b + std::sqrt(b * b - dot(from_m, from_m) + orbit_m * orbit_m);
  return from_m + along * range_m;
}

struct Orbit {
  const char* name;
  double radius_m, heading_deg;
};
constexpr Orbit orbits[] = {{"leo-300", 6678e3, 0.0},
                            {"leo-800", 7178e3, 80.0},
                            {"meo", 26560e3, 35.0},
                            {"geo", 42164e3, 90.0}};
constexpr double elevations_deg[] = {10.5, 20, 33, 46, 61, 75, 89.5};

/// Objects of every orbit at every elevation over Atlanta, in turn all around it.
std::string objects_over_atlanta(std::vector<std::string>& names) {
  const Site site{33.777, -84.398, 300.0};
  const EarthOrientation earth = earth_orientation(Clock(parse_utc(start)), {});
  const auto gcrs_from_itrs = earth.itrs_from_gcrs(sim_seconds(middle_s)).inverse();
  const Vec<Gcrs> site_m = gcrs_from_itrs * itrs_from_geodetic(site);
  std::string text;
  double azimuth_rad = 0.3;
  for (const Orbit& orbit : orbits)
    for (const double elevation_deg : elevations_deg) {
      azimuth_rad += 2.4;  // the golden angle
      const double c = std::cos(elevation_deg * deg);
      const Vec<Enu> line{c * std::sin(azimuth_rad), c * std::cos(azimuth_rad),
                          std::sin(elevation_deg * deg)};
      const Vec<Gcrs> along = gcrs_from_itrs * (enu_from_itrs(site).inverse() * line);
      names.push_back(std::string(orbit.name) + "-" + std::to_string(int(elevation_deg)));
      text += object_at(names.back(), on_orbit(site_m, along, orbit.radius_m), orbit.heading_deg);
    }
  return text;
}

const std::string dark =
    "effects: {sky: off, stars: off, photon_noise: off, dark_current: off, read_noise: off,"
    " full_well: off, quantisation: off, hot_pixels: off, cosmic_rays: off, prnu: off, "
    "column_noise:"
    " off, reference_pixels: off, scintillation: off, shadow: off, persistence: off}\n";

std::string scenario(const std::string& objects, const std::string& sensors,
                     const std::string& effects = dark) {
  return std::string("simulation: {start: ") + start + ", duration_s: 10, tick_s: 5}\nobjects:\n" +
         objects + effects + "sensors:\n" + sensors;
}

std::string sensor(const std::string& place, const std::string& camera, const std::string& pointing,
                   double exposure_s = 1.0, const std::string& more = "") {
  return "  - {name: eye, " + place + ", camera: " + camera + ", pointing: " + pointing +
         ", exposure_s: " + std::to_string(exposure_s) +
         ", cadence_s: 5, first_exposure_s: " + std::to_string(middle_s - exposure_s / 2) + more +
         "}\n";
}

/// How far from the frame's centre the camera of a stage has an object in mid exposure [px].
double off_centre_px(const test::Stage& stage, const SensorConfig& sensor,
                     const std::string& object) {
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const SimTime t = view.times().middle;
  const Motion motion = stage.states.motion(object_index(stage.states.roster(), object, "test"), t);
  const auto place = view.places(t).satellite(motion.position_m, motion.slope_m_per_s);
  const auto pixel = test::pixel_of(view, place.direction, t);
  const Optics& optics = sensor.camera.optics;
  return pixel ? std::hypot(pixel->x_px - (optics.columns - 1) / 2.0,
                            pixel->y_px - (optics.rows - 1) / 2.0)
               : 1e9;
}

/// Every camera of launch/cameras on every target with every mount that can be told to point at
/// one; names those that are off.
void expect_all_in_the_centre(test::Stage& stage, const std::vector<std::string>& targets) {
  for (const std::string& camera : preset_names("cameras")) {
    SensorConfig sensor = stage.scenario.sensors[0];
    sensor.camera = read_camera(YamlValue::load(find_preset("cameras", camera, "")));
    double worst_px = 0.0;
    for (const Tracking tracking : {Tracking::target, Tracking::sidereal, Tracking::fixed}) {
      if (tracking == Tracking::fixed && std::holds_alternative<PlatformConfig>(sensor.place))
        continue;
      sensor.tracking = tracking;
      for (const std::string& target : targets) {
        sensor.pointing = PointTarget{target};
        const double off_px = off_centre_px(stage, sensor, target);
        EXPECT_LT(off_px, tolerance_px)
            << camera << ", " << target << ", " << tracking_name(tracking);
        worst_px = std::max(worst_px, off_px);
      }
    }
    std::printf("%s: at most %.1g px\n", camera.c_str(), worst_px);
  }
}

TEST(TargetInCentre, OfEveryCameraOnTheGroundFrom10DegUp) {
  std::vector<std::string> targets;
  const std::string objects = objects_over_atlanta(targets);
  test::Stage stage(scenario(objects, sensor("site: atlanta", "raven", "{target: geo-46}")));
  expect_all_in_the_centre(stage, targets);
}

const std::string space_objects = object_at("platform", {7178e3, 0, 0}, 8) +
                                  object_at("crossing", {7378e3, 900e3, 300e3}, -60) +
                                  object_at("near", {7180e3, 10e3, 100e3}, 8.1) +
                                  object_at("meo", {20000e3, -17000e3, 5000e3}, 30) +
                                  object_at("geo", {25000e3, 33953e3, 100e3}, 90);
const std::vector<std::string> space_targets{"crossing", "near", "meo", "geo"};

TEST(TargetInCentre, OfEveryCameraInOrbit) {
  test::Stage stage(
      scenario(space_objects, sensor("platform: platform", "raven", "{target: geo}")));
  expect_all_in_the_centre(stage, space_targets);
}

TEST(TargetInCentre, WithWhateverIsSwitchedOff) {
  std::vector<std::string> targets;
  const std::string objects = objects_over_atlanta(targets);
  for (const EffectFacts& off : {AtmosphericRefraction::facts, LightTime::facts,
                                 DiurnalAberration::facts, AnnualAberration::facts}) {
    test::Stage ground(
        scenario(objects, sensor("site: atlanta", "telescope-3m", "{target: leo-300-20}")));
    test::Stage space(scenario(space_objects,
                               sensor("platform: platform", "telescope-3m", "{target: crossing}")));
    for (auto& [stage, target] :
         {std::pair<test::Stage&, std::string>{ground, "leo-300-20"}, {space, "crossing"}}) {
      stage.scenario.sensors[0].effects.set(off, false);
      EXPECT_LT(off_centre_px(stage, stage.scenario.sensors[0], target), tolerance_px) << off.name;
    }
  }
}

TEST(TargetInCentre, InTheAirThatTheWeatherSays) {
  std::vector<std::string> targets;
  const std::string objects = objects_over_atlanta(targets);
  test::Stage stage(
      scenario(objects, sensor("site: atlanta", "telescope-3m", "{target: leo-800-10}", 1.0,
                               ", weather: {pressure_hpa: 620, temperature_c: -12}")));
  for (const std::string& target : targets) {
    stage.scenario.sensors[0].pointing = PointTarget{target};
    EXPECT_LT(off_centre_px(stage, stage.scenario.sensors[0], target), tolerance_px) << target;
  }
}

const std::string goes_13 =
    "GOES 13\n"
    "1 29155U 06018A   18020.76993589 -.00000277  00000-0  00000+0 0  9990\n"
    "2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737\n";
/// GOES 13 stands 46 deg high here.
const std::string site_of_goes = "site: {latitude_deg: 34.35, longitude_deg: -84.398}";

std::string goes_scenario(const std::string& camera, const std::string& pointing) {
  return std::string("simulation: {start: ") + start + ", duration_s: 10, tick_s: 5}\n" +
         "objects: [{catalogue: objects.tle, radius_m: 3}]\n" + dark + "sensors:\n" +
         sensor(site_of_goes, camera, pointing);
}

/// The middle of the frame alone.
void crop(Optics& optics) {
  optics.columns = std::min(optics.columns, 256);
  optics.rows = std::min(optics.rows, 256);
}

// The whole pipeline, light and truth.
TEST(TargetInCentre, Goes13At46DegThroughThePipelineWithEveryCamera) {
  for (const std::string& camera : preset_names("cameras")) {
    test::Stage stage(goes_scenario(camera, "{target: GOES 13}"), "", goes_13);
    Optics& optics = stage.scenario.sensors[0].camera.optics;
    crop(optics);
    const auto frame = stage.frame();
    ASSERT_EQ(frame.truths.size(), 1u) << camera;
    const Truth& truth = frame.truths[0];
    EXPECT_NEAR(truth.true_elevation_rad / deg, 46.0, 0.1);
    const PixelPosition centre{(optics.columns - 1) / 2.0, (optics.rows - 1) / 2.0};
    EXPECT_LT(std::hypot(truth.middle_x_px - centre.x_px, truth.middle_y_px - centre.y_px),
              tolerance_px)
        << camera;
    EXPECT_LT(std::hypot(truth.rendered_x_px - centre.x_px, truth.rendered_y_px - centre.y_px),
              tolerance_px)
        << camera;
  }
}

// A plane camera images an angle t off its axis at f tan t from the principal point.
TEST(TargetInCentre, AnOffsetMovesItAlongColumnsAndRows) {
  test::Stage stage(
      goes_scenario("geo-watch", "{target: GOES 13, offset_deg: [0.4, -0.25], roll_deg: 33}"), "",
      goes_13);
  const Optics& optics = stage.scenario.sensors[0].camera.optics;
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  const double focal_px = optics.focal_length_m / optics.pixel_pitch_m;
  EXPECT_NEAR(frame.truths[0].middle_x_px,
              (optics.columns - 1) / 2.0 + focal_px * std::tan(0.4 * deg), tolerance_px);
  EXPECT_NEAR(frame.truths[0].middle_y_px,
              (optics.rows - 1) / 2.0 - focal_px * std::tan(0.25 * deg), tolerance_px);
}

// Light of a bright one, in counts.
TEST(TargetInCentre, TheCentroidOfLightIsInTheMiddle) {
  std::vector<std::string> targets;
  const std::string objects = objects_over_atlanta(targets);
  for (const std::string camera : {"raven", "telescope-3m", "gt-sort", "sst"})
    for (const std::string target : {"leo-800-46", "geo-33", "leo-300-10"}) {
      test::Stage stage(
          scenario(objects, sensor("site: atlanta", camera, "{target: " + target + "}")));
      Optics& optics = stage.scenario.sensors[0].camera.optics;
      crop(optics);
      const auto frame = stage.frame();
      const PixelPosition centre{(optics.columns - 1) / 2.0, (optics.rows - 1) / 2.0};
      const auto found = test::centroid(frame.counts, centre, 40);
      EXPECT_LT(std::hypot(found.x_px - centre.x_px, found.y_px - centre.y_px), tolerance_px)
          << camera << ", " << target << ", " << found.x_px << " " << found.y_px;
    }
}

TEST(TargetInCentre, FromTheFirstToTheLastInstantWhileItTracks) {
  std::vector<std::string> targets;
  const std::string objects = objects_over_atlanta(targets);
  test::Stage stage(
      scenario(objects, sensor("site: atlanta", "telescope-3m", "{target: leo-300-10}", 4.0)));
  SensorConfig& eye = stage.scenario.sensors[0];
  crop(eye.camera.optics);
  for (const std::string& target : targets) {
    eye.pointing = PointTarget{target};
    const View view(eye, frame_times(eye, 1), stage.states);
    for (const SimTime t : {view.times().start, view.times().middle, view.times().end}) {
      const Motion motion =
          stage.states.motion(object_index(stage.states.roster(), target, "test"), t);
      const auto place = view.places(t).satellite(motion.position_m, motion.slope_m_per_s);
      const auto pixel = test::pixel_of(view, place.direction, t);
      ASSERT_TRUE(pixel);
      EXPECT_LT(std::hypot(pixel->x_px - 127.5, pixel->y_px - 127.5), tolerance_px) << target;
    }
  }
}

// Reference: ERFA's refraction constants; the camera looks lower than the light comes from.
TEST(TargetInCentre, UnlessTheGeometricPlaceIsAskedFor) {
  test::Stage stage(goes_scenario("raven", "{target: GOES 13, place: geometric}"), "", goes_13);
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  double a_rad, b_rad;
  eraRefco(1013.25, 15.0, 0.5, stage.scenario.sensors[0].camera.band.centre_m * 1e6, &a_rad,
           &b_rad);
  const double z = pi / 2 - frame.truths[0].true_elevation_rad;
  const double tan_z = std::tan(z - a_rad * std::tan(z));
  const double up_px = (a_rad * tan_z + b_rad * tan_z * tan_z * tan_z) /
                       stage.scenario.sensors[0].camera.optics.pixel_angle_rad();
  // Light time and aberration: 0.35 arcsec each.
  EXPECT_NEAR(
      std::hypot(frame.truths[0].middle_x_px - 1023.5, frame.truths[0].middle_y_px - 1023.5), up_px,
      0.4);
  EXPECT_GT(up_px, 20.0);
  RecordProperty("off_px", std::to_string(up_px));
}

TEST(TargetInCentre, WhatItsKeyCannotSayIsNamed) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"{target: x, place: geometrc}", "s.yaml:1:20: place: must be one of apparent, geometric"},
      {"{ra_deg: 1, dec_deg: 2, place: geometric}", "s.yaml:1:32: place: goes with target"},
      {"{target: x, plce: geometric}", "plce: unknown key, did you mean place?"}};
  for (const auto& [text, message] : cases) {
    SensorConfig eye;
    try {
      read_pointing(YamlValue::parse(text, "s.yaml"), true, eye);
      ADD_FAILURE() << text;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
  }
}

// A host may have several numbers, as the modules of a station do.
TEST(TargetInCentre, WhatIsWhereTheSensorIsIsNeitherSeenNorPointedAt) {
  const std::string twins =
      object_at("platform", {7178e3, 0, 0}, 8) + object_at("twin", {7178e3, 0, 0}, 8);
  test::Stage stage(
      scenario(twins, sensor("platform: platform", "raven", "{ra_deg: 30, dec_deg: 20}")));
  EXPECT_TRUE(stage.frame().truths.empty());
  stage.scenario.sensors[0].pointing = PointTarget{"twin"};
  try {
    stage.frame();
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "eye: pointing.target: twin is where the sensor is, at frame 1");
  }
}

TEST(TargetInCentre, ASensorCannotPointAtWhatCarriesIt) {
  test::Stage stage(
      scenario(space_objects, sensor("platform: platform", "raven", "{target: geo}")));
  stage.scenario.sensors[0].pointing = PointTarget{"platform"};
  try {
    check_sensors(stage.scenario, stage.states.roster());
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find(
                  "sensors.eye.pointing.target: is the sensor's own platform, got platform"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace dmise
