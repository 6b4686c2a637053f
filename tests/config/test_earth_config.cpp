#include "core/config/objects/earth_config.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/config/scenario.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

// References: GeographicLib's LocalCartesian and Geocentric on the ellipsoids' published figures.
namespace dmise {
namespace {

const std::string start = "2018-01-21T00:30:00Z";

std::string text(const std::string& simulation, const std::string& objects = "",
                 const std::string& pointing = "zenith", const std::string& output = "") {
  return "simulation: {start: " + start + ", duration_s: 60, tick_s: 5" + simulation + "}\n" +
         (objects.empty() ? "" : "objects: [" + objects + "]\n") +
         "sensors:\n"
         "  - {name: a, site: {latitude_deg: -33, longitude_deg: 151, height_m: 90}, camera: raven,"
         " pointing: " +
         pointing + ", exposure_s: 1, cadence_s: 5}\n" + output;
}

class OwnEarth : public testing::Test {
 protected:
  std::filesystem::path directory = std::filesystem::path(testing::TempDir()) / "own-earth";
  void SetUp() override {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    std::filesystem::create_directories(directory);
  }
  void TearDown() override { std::filesystem::remove_all(directory); }

  Scenario load(const std::string& yaml) {
    std::ofstream(directory / "s.yaml") << yaml;
    return load_scenario((directory / "s.yaml").string());
  }
  /// Without the path.
  std::string complaint(const std::string& yaml) {
    try {
      load(yaml);
    } catch (const ConfigError& e) {
      const std::string message = e.what();
      return message.substr(message.find("s.yaml") + 7);
    }
    return "";
  }
};

struct Figure {
  std::string yaml;
  double a_m, f;
};
const Figure figures[] = {{"WGS84", 6378137.0, 1 / 298.257223563},
                          {"WGS72", 6378135.0, 1 / 298.26},
                          {"GRS80", 6378137.0, 1 / 298.257222101},
                          {"{a_m: 6371000, f: 0}", 6371000.0, 0.0},
                          {"{a_m: 6.4e6, f: 0.1}", 6.4e6, 0.1}};
const struct {
  double latitude_deg, longitude_deg, height_m;
} origins[] = {
    {33.777, -84.398, 300}, {-90, 20, 2800}, {0, 180, 0}, {89.9999, 359, 1e6}, {-23, -70, 1e9}};

std::string origin_key(double latitude_deg, double longitude_deg, double height_m) {
  char line[160];
  std::snprintf(line, sizeof line,
                ", origin: {latitude_deg: %.10g, longitude_deg: %.10g, height_m: %.10g}",
                latitude_deg, longitude_deg, height_m);
  return line;
}

Vec<Itrs> itrs_of(const GeographicLib::LocalCartesian& local,
                  const GeographicLib::Geocentric& earth, const Vec<Enu>& enu) {
  double latitude_deg, longitude_deg, height_m;
  local.Reverse(enu.x, enu.y, enu.z, latitude_deg, longitude_deg, height_m);
  Vec<Itrs> r;
  earth.Forward(latitude_deg, longitude_deg, height_m, r.x, r.y, r.z);
  return r;
}

TEST_F(OwnEarth, SitesAndHeightsAreOnItsEllipsoid) {
  for (const Figure& figure : figures) {
    const Scenario scenario = load(
        text(", ellipsoid: " + figure.yaml,
             "{name: x, motion: {fixed: {latitude_deg: 47, longitude_deg: 9, height_m: 5000}}}"));
    EXPECT_EQ(scenario.earth.ellipsoid, (Ellipsoid{figure.a_m, figure.f}));
    const GeographicLib::Geocentric earth(figure.a_m, figure.f);
    Vec<Itrs> site_m, object_m;
    earth.Forward(-33, 151, 90, site_m.x, site_m.y, site_m.z);
    EXPECT_EQ(itrs_from_geodetic(*site_of(scenario.sensors[0])), site_m) << figure.yaml;
    earth.Forward(47, 9, 5000, object_m.x, object_m.y, object_m.z);
    const auto& motion = std::get<MotionModel>(scenario.own_objects[0].motion.model);
    EXPECT_EQ(std::get<ConstantPosition<Itrs>>(motion).position_m, object_m) << figure.yaml;
  }
}

// A straight line and a track in east, north and up, to 1e-15 of the distance from the centre.
TEST_F(OwnEarth, MotionsInEastNorthAndUp) {
  for (const Figure& figure : figures)
    for (const auto& o : origins) {
      const Vec<Enu> first{3000, -2000, 5e6}, velocity{-250, 7000, 12.5};
      std::ofstream(directory / "path.csv")
          << "time_s,east_m,north_m,up_m\n0,3000,-2000,5e6\n40,-7000,278000,5000500\n";
      const Scenario scenario = load(text(
          ", ellipsoid: " + figure.yaml + origin_key(o.latitude_deg, o.longitude_deg, o.height_m),
          "{name: still, motion: {enu: {position_m: [3000, -2000, 5e6]}}}, "
          "{name: moving, motion: {enu: {position_m: [3000, -2000, 5e6], "
          "velocity_m_per_s: [-250, 7000, 12.5]}}}, "
          "{name: track, motion: {enu: {track: path.csv}}}"));
      const GeographicLib::Geocentric earth(figure.a_m, figure.f);
      const GeographicLib::LocalCartesian local(o.latitude_deg, o.longitude_deg, o.height_m, earth);
      const Clock clock(parse_utc(start));
      for (const double t_s : {0.0, 12.5, 40.0})
        for (const auto& object : scenario.own_objects) {
          const Vec<Enu> enu = object.name == "still" ? first : first + velocity * t_s;
          const auto state = std::get<MotionState<Itrs>>(
              path_at(std::get<MotionModel>(object.motion.model), clock.tai(sim_seconds(t_s))));
          const Vec<Itrs> expected = itrs_of(local, earth, enu);
          EXPECT_LT(norm(state.position_m - expected), 1e-8 + 3e-15 * norm(expected))
              << figure.yaml << " " << o.latitude_deg << " " << object.name << " " << t_s;
          if (object.name == "still") continue;
          const Vec<Itrs> step = itrs_of(local, earth, enu + velocity) - expected;
          EXPECT_LT(norm(state.velocity_m_per_s - step), 1e-4) << object.name;
        }
    }
}

TEST_F(OwnEarth, IsInTheDigestUnlessItIsTheDefault) {
  const std::string usual = physics_json(load(text("")));
  EXPECT_EQ(usual.find("ellipsoid"), std::string::npos);
  EXPECT_EQ(usual, physics_json(load(text(", ellipsoid: WGS84"))));
  EXPECT_EQ(usual,
            physics_json(load(text(", ellipsoid: {a_m: 6378137, f: 0.0033528106647474805}"))));
  EXPECT_NE(usual, physics_json(load(text(", ellipsoid: WGS72"))));
  EXPECT_EQ(usual, physics_json(load(text(", earth_albedo: 0.3"))));
  EXPECT_NE(usual, physics_json(load(text(", earth_albedo: 0.31"))));
  EXPECT_NE(usual, physics_json(load(text(", ellipsoid: GRS80"))));
  const std::string here = physics_json(load(text(origin_key(1, 2, 3))));
  EXPECT_NE(usual, here);
  EXPECT_NE(here, physics_json(load(text(origin_key(1, 2, 4)))));
}

TEST_F(OwnEarth, NonsenseIsRefused) {
  const std::string origin = origin_key(33, -84, 300);
  std::ofstream(directory / "under.csv") << "time_s,east_m,north_m,up_m\n0,0,0,100\n9,0,0,-400\n";
  const auto object = [&](const std::string& motion) {
    return text(origin, "{name: x, motion: " + motion + "}");
  };
  const std::pair<std::string, std::string> cases[] = {
      {text(", ellipsoid: WGS48"),
       "simulation.ellipsoid: must be one of WGS84, WGS72, GRS80, did you mean WGS84?, got WGS48"},
      {text(", ellipsoid: [WGS84]"), "simulation.ellipsoid: "},
      {text(", elipsoid: WGS84"), "simulation.elipsoid: unknown key, did you mean ellipsoid?"},
      {text(", ellipsoid: {a_m: 0, f: 0}"), "simulation.ellipsoid.a_m: must be >= 6"},
      {text(", ellipsoid: {a_m: -6378137, f: 0}"), "simulation.ellipsoid.a_m: must be >= 6"},
      {text(", ellipsoid: {a_m: 6378.137, f: 0}"), "simulation.ellipsoid.a_m: must be >= 6"},
      {text(", ellipsoid: {a_m: 6378137, f: 1}"), "simulation.ellipsoid.f: must be <= 0.1, got 1"},
      {text(", ellipsoid: {a_m: 6378137, f: 298.257}"), "simulation.ellipsoid.f: must be <= 0.1"},
      {text(", ellipsoid: {a_m: 6378137, f: -0.003}"), "simulation.ellipsoid.f: must be >= 0"},
      {text(", ellipsoid: {a_m: .nan, f: 0}"), "simulation.ellipsoid.a_m: "},
      {text(", ellipsoid: {a_m: 6378137}"), "simulation.ellipsoid.f: is missing"},
      {text(", ellipsoid: {a_m: 6378137, f: 0, b_m: 1}"), "simulation.ellipsoid.b_m: unknown key"},
      {text(origin_key(90.1, 0, 0)), "simulation.origin.latitude_deg: must be <= 90, got 90.1"},
      {text(origin_key(0, 361, 0)), "simulation.origin.longitude_deg: must be <= 360, got 361"},
      {text(origin_key(0, 0, -2e4)), "simulation.origin.height_m: must be >= -12000"},
      {text(", origin: {latitude_deg: 1}"), "simulation.origin.longitude_deg: is missing"},
      {text("", "{name: x, motion: {enu: {position_m: [0, 0, 9]}}}"),
       "objects[0].motion.enu: needs simulation.origin"},
      {object("{enu: {}}"), "motion.enu: give either position_m (and velocity_m_per_s) or track"},
      {object("{enu: {track: under.csv, position_m: [0, 0, 9]}}"), "motion.enu: give either"},
      {object("{enu: {track: under.csv, velocity_m_per_s: [0, 0, 9]}}"), "goes with position_m"},
      {object("{enu: {position_m: [0, 0, -301]}}"), "position_m: is inside the Earth"},
      {object("{enu: {position_m: [0, .inf, 0]}}"), "position_m[1]"},
      {object("{enu: {track: none.csv}}"), "motion.enu.track: there is no such file"},
      {object("{enu: {track: under.csv}}"),
       "csv:3: must be 2 m above the ellipsoid or higher, got"},
      {text("", "", "{enu: {look: [0, 1, 0]}}"),
       "sensors[0].pointing.enu: needs simulation.origin"},
      {text(origin, "", "{enu: {}}"), "pointing.enu: give either look or look_at_m (and up)"},
      {text(origin, "", "{enu: {look: [0, 0, 0]}}"), "pointing.enu.look: must not be zero"},
      {text(origin, "", "{enu: {look: [0, 2, 0], up: [0, -1, 0]}}"), "up: must not be along look"},
      {text(origin, "", "{enu: {look: [0, 1, 0]}, roll_deg: 3}"), "is rolled by up"},
      {text(origin, "", "{enu: {look: [0, 1, 0]}, tracking: target}"), "no target to track"},
      {text("", "", "zenith", "output: {positions: [csv], positions_frame: enu}\n"),
       "output.positions_frame: enu needs simulation.origin"},
      {text(origin, "", "zenith", "output: {positions: [oem], positions_frame: enu}\n"),
       "output.positions_frame: is of positions: [csv] or [jsonl]"}};
  for (const auto& [yaml, message] : cases) {
    const std::string said = complaint(yaml);
    EXPECT_NE(said.find(message), std::string::npos) << message << "\n" << said;
  }
}

}  // namespace
}  // namespace dmise
