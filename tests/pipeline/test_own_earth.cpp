#include <GeographicLib/Geocentric.hpp>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "sensors/scene/view.h"
#include "tests/pipeline/wiring.h"

// An ellipsoid and an origin of the scenario's own, where frames use them.
namespace dmise {
namespace {

const std::string site = "site: {latitude_deg: -30.2, longitude_deg: -70.7, height_m: 2000}";
const std::string noon = "2018-03-06T12:00:00Z";

TEST(OwnEarth, ASiteIsOnItsEllipsoid) {
  const auto position_m = [](const std::string& ellipsoid) {
    test::Stage stage(
        test::scenario(noon, 20, site, test::camera(8, 8, 0.1), "zenith", 10, 20, "", ellipsoid));
    const View view(stage.scenario.sensors[0], frame_times(stage.scenario.sensors[0], 1),
                    stage.states);
    const SimTime t = view.times().middle;
    const auto frame = stage.frame();
    EXPECT_LT(norm(frame.header.sensor_position_m - view.observer(t).position_m), 1e-6);
    return view.earth().itrs_from_gcrs(t) * view.observer(t).position_m;
  };
  const std::tuple<std::string, double, double> cases[] = {
      {"", 6378137.0, 1 / 298.257223563},
      {", ellipsoid: WGS72", 6378135.0, 1 / 298.26},
      {", ellipsoid: {a_m: 6371000, f: 0}", 6371e3, 0.0}};
  for (const auto& [key, a_m, f] : cases) {
    Vec<Itrs> expected;
    GeographicLib::Geocentric(a_m, f).Forward(-30.2, -70.7, 2000, expected.x, expected.y,
                                              expected.z);
    EXPECT_LT(norm(position_m(key) - expected), 1e-6) << key;
  }
}

std::string fixed_gcrs(const std::string& name, const Vec<Gcrs>& r) {
  char text[200];
  std::snprintf(text, sizeof text,
                "  - {name: %s, motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}}\n", name.c_str(),
                r.x, r.y, r.z);
  return text;
}

// Near the pole, 700 km behind the terminator: the penumbra there reaches 3.3 km to either side of
// the limb's shadow, and the limb of WGS 84 is f sin^2(colatitude) = 19 km lower than a sphere's.
TEST(OwnEarth, CastsTheShadow) {
  const double a_m = 6378137.0;
  const auto lit_at = [&](const std::string& ellipsoid, double below_m) {
    test::Stage without(test::scenario(noon, 20, site, test::camera(8, 8, 0.1), "zenith", 10, 20));
    const Vec<Gcrs> sun = unit(without.states.environment(sim_seconds(5.0)).sun_m), pole{0, 0, 1};
    const Vec<Gcrs> aside = unit(pole - sun * dot(pole, sun));
    const Vec<Gcrs> r = aside * (a_m - below_m) - sun * 7e5;
    test::Stage stage(test::scenario(
        noon, 20, "platform: eye", test::camera(64, 64, 0.05), "{target: x}", 1, 20, "", ellipsoid,
        "objects:\n" + fixed_gcrs("x", r) + fixed_gcrs("eye", aside * 9e6 + sun * 1e6)));
    return stage.frame().truths.at(0).sunlit;
  };
  EXPECT_EQ(lit_at("", 9e3), 1.0);
  EXPECT_EQ(lit_at(", ellipsoid: {a_m: 6378137, f: 0}", 9e3), 0.0);
  EXPECT_EQ(lit_at(", ellipsoid: {a_m: 6378137, f: 0}", -9e3), 1.0);
  EXPECT_EQ(lit_at("", 30e3), 0.0);
  EXPECT_EQ(lit_at(", ellipsoid: {a_m: 6378137, f: 0.01}", 30e3), 1.0);
}

// Over the pole, between a sphere and WGS 84, 21 km lower.
TEST(OwnEarth, HidesWhatIsBehindIt) {
  const auto hidden = [&](const std::string& ellipsoid) {
    test::Stage stage(test::scenario(
        noon, 20, "platform: eye", test::camera(8, 8, 0.1), "{target: x}", 1, 20, "", ellipsoid,
        "objects:\n" + fixed_gcrs("x", {2e7, 0, 6.368e6}) + fixed_gcrs("eye", {-2e7, 0, 6.368e6})));
    const View view(stage.scenario.sensors[0], frame_times(stage.scenario.sensors[0], 1),
                    stage.states);
    return view.earth_occultation({})->hides_object({2e7, 0, 6.368e6}, {1, 0, 0});
  };
  EXPECT_FALSE(hidden(""));
  EXPECT_FALSE(hidden(", ellipsoid: GRS80"));
  EXPECT_TRUE(hidden(", ellipsoid: {a_m: 6378137, f: 0}"));
}

// A camera that flies past: in mid exposure, 2.5 s from the start, the thing that it looks at is in
// the middle, and what stands above that towards `up`.
const std::string origin =
    ", origin: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}";
const std::string plain =
    "effects: {sky: off, photon_noise: off, dark_current: off, read_noise: off, full_well: off,"
    " quantisation: off, annual_aberration: off, diurnal_aberration: off, light_time: off,"
    " shadow: off, limb_air: off, limb_airglow: off}\n";

std::string enu_object(const std::string& name, const Vec<Enu>& r, const Vec<Enu>& v = {}) {
  char text[240];
  std::snprintf(text, sizeof text,
                "  - {name: %s, motion: {enu: {position_m: [%.6f, %.6f, %.6f], velocity_m_per_s: "
                "[%.6f, %.6f, %.6f]}}, radius_m: 0.3}\n",
                name.c_str(), r.x, r.y, r.z, v.x, v.y, v.z);
  return text;
}

void expect_light(const Vec<Enu>& eye, const Vec<Enu>& velocity, const Vec<Enu>& thing,
                  const std::string& pointing, double right_px, double up_px) {
  SCOPED_TRACE(pointing);
  test::Stage stage("simulation: {start: 2018-01-21T18:00:00Z, duration_s: 10, tick_s: 5" + origin +
                    "}\nobjects:\n" + enu_object("eye", eye, velocity) +
                    enu_object("thing", thing) + plain +
                    "sensors:\n  - {name: a, platform: eye, camera: raven, pointing: " + pointing +
                    ", exposure_s: 0.01, cadence_s: 5, first_exposure_s: 2.495}\n");
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  const PixelPosition at{(frame.counts.columns - 1) / 2.0 + right_px,
                         (frame.counts.rows - 1) / 2.0 - up_px};
  EXPECT_NEAR(frame.truths[0].middle_x_px, at.x_px, 1e-3);
  EXPECT_NEAR(frame.truths[0].middle_y_px, at.y_px, 1e-3);
  const auto found = test::centroid(frame.counts, at, 30);
  EXPECT_NEAR(found.x_px, at.x_px, 0.02);
  EXPECT_NEAR(found.y_px, at.y_px, 0.02);
}

TEST(FreeCamera, LooksAtAPlaceWhileItMoves) {
  const Vec<Enu> eye{-4e5, 2e4, 6e4}, velocity{300, 100, -5}, thing{1e5, 3e5, 1.5e5};
  expect_light(eye, velocity, thing, "{enu: {look_at_m: [1e5, 3e5, 1.5e5]}}", 0, 0);
  expect_light(eye, velocity, thing, "{enu: {look_at_m: [1e5, 3e5, 1.5e5], up: [1, 0, 0.2]}}", 0,
               0);
}

TEST(FreeCamera, LooksInADirectionWithUpUp) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  test::Stage any(test::scenario(noon, 20, site, "raven", "zenith", 1, 20));
  const double focal_px = any.scenario.sensors[0].camera.optics.focal_length_px();
  const Vec<Enu> eye{1e4, -2e4, 3e4}, velocity{-120, 50, 10};
  const Vec<Enu> there = eye + velocity * 2.5;
  const double range_m = 2e5, tangent = 1e-4;
  struct Case {
    const char* yaml;
    Vec<Enu> look, up;
  };
  for (const Case& c : {Case{"{enu: {look: [3, 4, 0]}}", {0.6, 0.8, 0}, {0, 0, 1}},
                        Case{"{enu: {look: [3, 4, 0], up: [0, 0, -2]}}", {0.6, 0.8, 0}, {0, 0, -1}},
                        // The image's top is the part of `up` across the line.
                        Case{"{enu: {look: [0, 1, 1], up: [0, 0, 1]}}",
                             {0, std::sqrt(0.5), std::sqrt(0.5)},
                             {0, -std::sqrt(0.5), std::sqrt(0.5)}},
                        Case{"{enu: {look: [0, 0, 1]}}", {0, 0, 1}, {0, 1, 0}}}) {
    const Vec<Enu> right = cross(c.look, c.up);
    expect_light(eye, velocity, there + (c.look + c.up * (2 * tangent) + right * tangent) * range_m,
                 c.yaml, tangent * focal_px, 2 * tangent * focal_px);
  }
}

TEST(FreeCamera, WhereItLooksAtIsNamed) {
  test::Stage stage("simulation: {start: 2018-01-21T18:00:00Z, duration_s: 10, tick_s: 5" + origin +
                    "}\nobjects:\n" + enu_object("eye", {0, 0, 1e5}) +
                    "sensors:\n  - {name: a, platform: eye, camera: raven, pointing: {enu: "
                    "{look_at_m: [0, 0, 1e5]}}, exposure_s: 1, cadence_s: 5}\n");
  try {
    stage.frame();
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(
        std::string(e.what()).find("sensors[0].pointing.enu: the sensor is where it looks at"),
        std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace dmise
