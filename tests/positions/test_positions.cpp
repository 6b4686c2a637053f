#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <fstream>

#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/orbit/oem.h"
#include "sensors/positions/positions_evaluator.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

const std::string yaml =
    "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 40, tick_s: 5}\n"
    "objects:\n"
    "  - name: platform\n"
    "    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6,"
    " raan_deg: 0, true_anomaly_deg: 0}}\n"
    "    attitude: nadir\n"
    "sensors:\n"
    "  - {name: eye, platform: platform, camera: raven, pointing: {ra_deg: 30, dec_deg: -20},"
    " exposure_s: 1, cadence_s: 10}\n"
    "  - {name: site, site: atlanta, camera: raven, pointing: zenith, exposure_s: 1, cadence_s: "
    "10}\n"
    "output: {positions: [csv, jsonl, oem]}\n";

/// Runs the evaluator over the actors' states, from `first` on, telling it the tick before.
void run(test::Stage& stage, const std::string& out, Tick first, Tick last) {
  const Clock clock = make_clock(stage.scenario);
  OrbitActor orbit(stage.scenario, clock, stage.threads);
  EnvironmentActor environment(stage.scenario, clock);
  PositionsEvaluator evaluator(stage.scenario, clock, out);
  std::vector<Message> past;
  for (Tick tick = 0; tick <= last; ++tick) {
    std::vector<Message> inputs = orbit.step(tick, {});
    for (auto& message : environment.step(tick, {}))
      if (message.topic == environment_topic) inputs.push_back(message);
    if (tick >= first) {
      if (first > 0 && tick == first) evaluator.resume(first, past);
      evaluator.step(tick, inputs);
    } else {
      for (auto& message : inputs)
        if (tick + 1 == first || std::holds_alternative<ObjectRoster>(*message.state))
          past.push_back(message);
    }
  }
}

std::vector<std::string> rows_of(const std::string& path, const std::string& what) {
  std::vector<std::string> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.find(what) != std::string::npos) rows.push_back(line);
  return rows;
}

std::vector<double> numbers(const std::string& row) {
  std::vector<double> values;
  std::stringstream fields(row);
  for (std::string field; std::getline(fields, field, ',');)
    values.push_back(std::strtod(field.c_str(), nullptr));
  return values;
}

TEST(Positions, AreThoseOfTheMotionTheSkyAndTheGround) {
  test::Stage stage(yaml);
  const std::string out = stage.directory.string();
  run(stage, out, 0, stage.scenario.last_tick());
  const std::string csv = out + "/positions.csv";
  const auto platform = rows_of(csv, ",object,platform,");
  ASSERT_EQ(platform.size(), 9u);
  const auto last = numbers(platform.back());  // 40 s at the root of mu / a^3
  const double u = std::sqrt(3.986004418e14 / std::pow(7178137.0, 3)) * 40;
  EXPECT_NEAR(last[5], 7178.137 * std::cos(u), 1e-5);
  EXPECT_NEAR(last[7], 7178.137 * std::sin(u) * std::sin(98.6 * deg), 1e-5);
  EXPECT_EQ(platform[0].substr(0, 33), "0,2018-01-21T00:15:00.000000000Z,");
  // z of a nadir attitude looks down: from its quaternion, v' = 2 (x z + w y), 2 (y z - w x), ..
  const double w = last[11], x = last[12], y = last[13], z = last[14];
  EXPECT_NEAR(2 * (x * z + w * y), -std::cos(u), 1e-9);
  EXPECT_NEAR(1 - 2 * (x * x + y * y), -std::sin(u) * std::sin(98.6 * deg), 1e-9);
  // z of the camera's axes is its boresight.
  const auto eye = numbers(rows_of(csv, ",camera,eye,").at(3));
  EXPECT_NEAR(2 * (eye[12] * eye[14] + eye[11] * eye[13]), std::cos(30 * deg) * std::cos(20 * deg),
              1e-12);
  EXPECT_NEAR(1 - 2 * (eye[12] * eye[12] + eye[13] * eye[13]), -std::sin(20 * deg), 1e-12);
  // A site keeps its distance from the Earth's centre and goes round with it.
  const auto site = numbers(rows_of(csv, ",camera,site,").at(0));
  const auto later = numbers(rows_of(csv, ",camera,site,").at(8));
  EXPECT_NEAR(std::hypot(site[5], site[6], site[7]), std::hypot(later[5], later[6], later[7]),
              1e-6);
  const double sin_latitude = std::sin(33.777 * deg);
  const double from_axis_km =
      (6378.137 / std::sqrt(1 - 0.00669437999014 * sin_latitude * sin_latitude) + 0.3) *
      std::cos(33.777 * deg);
  EXPECT_NEAR(std::hypot(later[5] - site[5], later[6] - site[6], later[7] - site[7]),
              7.292115e-5 * 40 * from_axis_km, 1e-4);
  const auto sun = numbers(rows_of(csv, ",sun,").at(0)),
             moon = numbers(rows_of(csv, ",moon,").at(0));
  // The U.S. Naval Observatory's approximation, good to 3e-4 au.
  const double g = (357.529 + 0.98560028 * (2458139.510417 - 2451545.0)) * deg;
  EXPECT_NEAR(std::hypot(sun[5], sun[6], sun[7]) / 149597870.7,
              1.00014 - 0.01671 * std::cos(g) - 0.00014 * std::cos(2 * g), 3e-4);
  EXPECT_GT(std::hypot(moon[5], moon[6], moon[7]), 356e3);
  EXPECT_LT(std::hypot(moon[5], moon[6], moon[7]), 407e3);
}

TEST(Positions, OfAPlatformAreAnEphemerisThatBringsItBack) {
  test::Stage stage(yaml);
  const std::string out = stage.directory.string();
  run(stage, out, 0, stage.scenario.last_tick());
  const Trajectory path = read_oem(out + "/positions/platform-990000001.oem");
  const Clock clock = make_clock(stage.scenario);
  for (const double t_s : {0.0, 2.5, 17.3, 38.9}) {
    const auto state = std::get<MotionState<Gcrs>>(path_at(path, clock.tai(sim_seconds(t_s))));
    const Motion there = stage.states.motion(0, sim_seconds(t_s));
    EXPECT_LT(norm(state.position_m - there.position_m), 0.01) << t_s;
  }
}

// Reference: GeographicLib's LocalCartesian, and the scenario's own line.
TEST(Positions, InEastNorthAndUpOfTheScenariosOrigin) {
  test::Stage stage(
      "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 40, tick_s: 5, ellipsoid: WGS72,"
      " origin: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}}\n"
      "objects:\n"
      "  - name: kite\n"
      "    motion: {enu: {position_m: [1000, -2000, 500], velocity_m_per_s: [20, 30, 5]}}\n"
      "sensors:\n"
      "  - {name: eye, platform: kite, camera: raven, pointing: {enu: {look: [0, 3, 4]}},"
      " exposure_s: 1, cadence_s: 10}\n"
      "  - {name: site, site: {latitude_deg: 34.5, longitude_deg: -83, height_m: 700}, camera: "
      "raven, pointing: zenith, exposure_s: 1, cadence_s: 10}\n"
      "output: {positions: [csv, jsonl, oem], positions_frame: enu}\n");
  const std::string out = stage.directory.string(), csv = out + "/positions.csv";
  run(stage, out, 0, stage.scenario.last_tick());
  EXPECT_EQ(rows_of(csv, "tick,").at(0),
            "tick,time_utc,kind,name,catalogue_number,east_km,north_km,up_km,veast_km_per_s,"
            "vnorth_km_per_s,vup_km_per_s,qw,qx,qy,qz");
  const GeographicLib::LocalCartesian local(33.777, -84.398, 300,
                                            GeographicLib::Geocentric(6378135.0, 1 / 298.26));
  double east_m, north_m, up_m;
  local.Forward(34.5, -83, 700, east_m, north_m, up_m);
  for (const auto& row : rows_of(csv, ",camera,site,")) {
    const auto site = numbers(row);
    EXPECT_NEAR(site[5] * 1e3, east_m, 1e-6);
    EXPECT_NEAR(site[6] * 1e3, north_m, 1e-6);
    EXPECT_NEAR(site[7] * 1e3, up_m, 1e-6);
    EXPECT_LT(std::hypot(site[8], site[9], site[10]), 1e-12);
  }
  for (const char* what : {",object,kite,", ",camera,eye,"}) {
    const auto rows = rows_of(csv, what);
    ASSERT_EQ(rows.size(), 9u);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto kite = numbers(rows[k]);
      const double t_s = 5.0 * double(k),
                   expected[] = {1000 + 20 * t_s, -2000 + 30 * t_s, 500 + 5 * t_s, 20, 30, 5};
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(kite[5 + i] * 1e3, expected[i], i < 3 ? 1e-6 : 1e-8) << what << k << " " << i;
    }
  }
  // z of the camera's axes is along (0, 0.6, 0.8).
  const auto q = numbers(rows_of(csv, ",camera,eye,").at(4));
  EXPECT_NEAR(2 * (q[12] * q[14] + q[11] * q[13]), 0.0, 1e-12);
  EXPECT_NEAR(2 * (q[13] * q[14] - q[11] * q[12]), 0.6, 1e-12);
  EXPECT_NEAR(1 - 2 * (q[12] * q[12] + q[13] * q[13]), 0.8, 1e-12);
  EXPECT_EQ(rows_of(out + "/positions.jsonl", "\"position_enu_km\"").size(),
            rows_of(csv, ",").size() - 1);
  // The ephemeris stays in GCRF.
  const Trajectory path = read_oem(out + "/positions/kite-990000001.oem");
  const Clock clock = make_clock(stage.scenario);
  const auto state = std::get<MotionState<Gcrs>>(path_at(path, clock.tai(sim_seconds(20.0))));
  EXPECT_LT(norm(state.position_m - stage.states.motion(0, sim_seconds(20.0)).position_m), 0.01);
}

// At a tick that is the middle of an exposure, the attitude is that of the frame.
TEST(Positions, OfAMountThatFollowsAnObjectAreThoseOfItsFrames) {
  for (const std::string place : {"", ", place: geometric"}) {
    test::Stage stage(
        "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5}\n"
        "objects:\n"
        "  - name: low\n"
        "    motion: {fixed: {latitude_deg: 28, longitude_deg: -80, height_m: 800000}}\n"
        "sensors:\n"
        "  - {name: eye, site: atlanta, camera: telescope-3m, pointing: {target: low" +
        place +
        "}, exposure_s: 1, cadence_s: 5, first_exposure_s: 4.5, weather: {pressure_hpa: 900}}\n"
        "effects: {sky: off}\noutput: {positions: [csv]}\n");
    run(stage, stage.directory.string(), 0, stage.scenario.last_tick());
    const auto row =
        numbers(rows_of(stage.directory.string() + "/positions.csv", ",camera,eye,").at(1));
    const Quaternion q = stage.frame().header.camera_from_gcrs[1];
    // The inverse of camera from GCRS, of either sign.
    const double same = row[11] * q.w - row[12] * q.x - row[13] * q.y - row[14] * q.z;
    EXPECT_NEAR(std::abs(same), 1.0, 1e-15);
    const double x = row[12] * q.w + row[11] * q.x, y = row[13] * q.w + row[11] * q.y;
    EXPECT_LT(std::hypot(x, y), 1e-9);
  }
}

TEST(Positions, TakenUpAtAnyTickTheyBecomeTheSameBytes) {
  test::Stage stage(yaml);
  const std::string out = (stage.directory / "out").string();
  const std::vector<std::string> names{"/positions.csv", "/positions.jsonl",
                                       "/positions/platform-990000001.oem"};
  run(stage, out, 0, stage.scenario.last_tick());
  std::vector<std::string> whole;
  for (const auto& name : names) whole.push_back(read_text_file(out + name));
  for (const Tick tick : {1, 2, 5, 8}) {
    run(stage, out, tick, stage.scenario.last_tick());
    for (std::size_t k = 0; k < names.size(); ++k)
      EXPECT_EQ(read_text_file(out + names[k]), whole[k]) << names[k] << " at tick " << tick;
  }
  EXPECT_EQ(last_tick_written(out), 8);
}

}  // namespace
}  // namespace dmise
