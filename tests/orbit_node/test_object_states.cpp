#include "core/propagation/object_states.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/units.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/scene/state_window.h"
#include "tests/orbit_node/scenario_directory.h"

namespace dmise {
namespace {

using test::ScenarioDirectory;

// One object for each motion model; a low orbit of e = 0.02 where the model has one.
const std::string all_models = R"(
  - {name: kepler, attitude: nadir, motion: {two_body: {semi_major_axis_m: 7.0e6, eccentricity: 0.02,
     inclination_deg: 60, raan_deg: 40, true_anomaly_deg: 30}}}
  - {name: file, attitude: sun_tracking, motion: {oem: inspector.oem}}
  - {name: mast, attitude: {spinning: {axis: [0, 1, 3], rate_rpm: 60, phase_deg: 20}},
     motion: {fixed: {latitude_deg: 33.7, longitude_deg: -84.4, height_m: 350}}}
  - {name: beacon, attitude: {table: turns.csv}, motion: {fixed: {gcrs_m: [0, 4.2e7, 1.0e6]}}}
  - name: elements
    attitude: {inertial: {gcrs_from_body: [0.5, 0.5, -0.5, 0.5]}}
    motion:
      sgp4:
        line1: 1 29155U 06018A   18020.76993589 -.00000277  00000-0  00000+0 0  9990
        line2: 2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737
)";

class ObjectStatesTest : public ScenarioDirectory {
 protected:
  void SetUp() override {
    ScenarioDirectory::SetUp();
    std::filesystem::copy_file(DMISE_SOURCE_DIR "/launch/scenarios/inspector.oem",
                               directory / "inspector.oem");
    write("turns.csv", "time_s,w,x,y,z\n-10,1,0,0,0\n90,0,0,1,0\n");
  }
};

std::size_t index_of(const ObjectPopulation& population, const std::string& name) {
  return object_index(population.roster, name, "test");
}

// The ticks are 10 s apart. Cubic on an orbit of radius r and rate n: r (n h)^4 / 384 = 0.26 mm at
// 7000 km; SGP4 itself is good to centimetres there ("CubicAt10SecondsIsGoodToCentimetres").
TEST_F(ObjectStatesTest, BetweenTicksEveryModelIsInterpolatedToAMillimetre) {
  const Scenario scenario = load(all_models);
  const Clock clock = make_clock(scenario);
  Threads threads(1);
  const auto population = load_objects(scenario, clock);
  const StateSource source(population, clock, threads);
  StateWindow window;
  window.add(std::make_shared<const ObjectRoster>(population.roster));
  for (Tick k = 0; k <= 6; ++k)
    window.add(std::make_shared<const ObjectStates>(source.at(k, scenario.time_of(k))));
  double worst_m[5] = {}, worst_m_per_s[5] = {}, worst_rad[5] = {};
  for (std::int64_t ms = 500; ms < 60000; ms += 1700) {
    const SimTime t{ms * 1'000'000};
    const ObjectStates direct = source.at(0, t);
    for (std::size_t i = 0; i < direct.count; ++i) {
      const Motion between = window.motion(i, t);
      worst_m[i] = std::max(worst_m[i], norm(between.position_m - direct.position(i)));
      worst_m_per_s[i] = std::max(worst_m_per_s[i], norm(between.slope_m_per_s - direct.slope(i)));
      const auto attitude = window.gcrs_from_body(i, t);
      ASSERT_TRUE(attitude && direct.attitude(i));
      const auto truth = rotation_of<Gcrs, Body>(direct.attitude(i)->gcrs_from_body);
      for (const Vec<Body>& axis : {Vec<Body>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
        worst_rad[i] = std::max(worst_rad[i], angle_rad(*attitude * axis, truth * axis));
    }
  }
  for (const auto& object : population.roster.objects) {
    const std::size_t i = index_of(population, object.name);
    EXPECT_LT(worst_m[i], 1e-3) << object.name;
    EXPECT_LT(worst_m_per_s[i], 1e-3) << object.name;
    EXPECT_LT(worst_rad[i], 0.001 * arcsec) << object.name;
  }
}

TEST_F(ObjectStatesTest, SlopeIsTheDerivativeOfThePosition) {
  const Scenario scenario = load(all_models);
  const Clock clock = make_clock(scenario);
  Threads threads(1);
  const auto population = load_objects(scenario, clock);
  const StateSource source(population, clock, threads);
  const ObjectStates at = source.at(0, {30'000'000'000}), before = source.at(0, {29'900'000'000}),
                     after = source.at(0, {30'100'000'000});
  for (std::size_t i = 0; i < at.count; ++i)
    EXPECT_LT(norm(at.slope(i) - (after.position(i) - before.position(i)) / 0.2), 1e-4)
        << population.roster.objects[i].name;
}

// A point of the equator's plane moves with the Earth: 465.1 m/s at 6378.137 km, and in proportion.
TEST_F(ObjectStatesTest, WhatIsFixedToTheEarthTurnsWithIt) {
  const Scenario scenario = load(
      "  - {name: m, motion: {fixed: {itrs_m: [6378137, 0, 0]}}}\n"
      "  - {name: s, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n");
  const Clock clock = make_clock(scenario);
  Threads threads(1);
  const auto population = load_objects(scenario, clock);
  const ObjectStates states = StateSource(population, clock, threads).at(0, {0});
  EXPECT_NEAR(norm(states.slope(0)), 465.1, 0.05);
  EXPECT_EQ(norm(states.slope(1)), 0.0);
}

TEST_F(ObjectStatesTest, OutsideItsSpanAnObjectLeavesTheSceneWithOneLineThatNamesTheSpan) {
  std::ifstream whole(directory / "inspector.oem");
  std::string text, line;
  while (std::getline(whole, line))
    if (line.find("00:18:00 ") == line.npos && line.find("00:19:00 ") == line.npos &&
        line.find("00:17:00 ") == line.npos && line.find("00:16:00 ") == line.npos)
      text += line + "\n";
  write("short.oem", text);  // ends with the run's start
  const Scenario scenario = load(
      "  - {name: probe, motion: {oem: short.oem}, attitude: nadir}\n"
      "  - {name: other, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n");
  Threads threads(1);
  OrbitActor actor(scenario, make_clock(scenario), threads);
  ASSERT_EQ(actor.notes().size(), 1u);
  EXPECT_THAT(actor.notes()[0],
              testing::HasSubstr("2018-01-21T00:13:00.000 to 2018-01-21T00:15:00.000 UTC"));
  std::vector<std::string> told;
  actor.on_absence([&](const std::string& text) { told.push_back(text); });
  for (Tick k = 0; k <= 6; ++k) {
    const auto messages = actor.step(k, {});
    const auto& states = std::get<ObjectStates>(*messages.back().state);
    EXPECT_EQ(states.code[0], k == 0 ? 0 : std::uint8_t(MotionCode::outside_span));
    EXPECT_EQ(states.attitude(0).has_value(), k == 0);
    EXPECT_EQ(norm(states.position(0)) > 0, k == 0);
    EXPECT_EQ(states.code[1], 0);
  }
  ASSERT_EQ(told.size(), 1u);
  EXPECT_THAT(told[0], testing::AllOf(testing::HasSubstr("probe (990000001)"),
                                      testing::HasSubstr("at 2018-01-21T00:15:10"),
                                      testing::HasSubstr("2018-01-21T00:13:00.000 to ")));
}

// Each of the five codes and ours, from the verification set and a broken orbit: the object leaves
// with one line, its neighbours are what they are without it.
TEST_F(ObjectStatesTest, AnObjectThatDecaysLeavesTheSceneWithOneLine) {
  // Catalogue number 28872 of the verification set decays within an hour of its epoch (code 6).
  write("decaying.tle",
        "1 28872U 05037B   05333.02012661  .25992681  00000-0  24476-3 0  1534\n"
        "2 28872  96.4736 157.9986 0303955 244.0492 110.6523 16.46015938 10708\n");
  write("scenario.yaml",
        "simulation: {start: 2005-11-29T00:30:00Z, duration_s: 3600, tick_s: 60}\n"
        "objects:\n  - {catalogue: decaying.tle}\n"
        "  - {name: falls, motion: {two_body: {position_m: [7e6, 0, 0], velocity_m_per_s: [0, 0, "
        "0]}}}\n"
        "  - {name: stays, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n"
        "sensors:\n  - {name: a, site: atlanta, camera: omnissa, pointing: zenith, exposure_s: 2, "
        "cadence_s: 30}\n");
  const Scenario scenario = load_scenario((directory / "scenario.yaml").string());
  Threads threads(1);
  OrbitActor actor(scenario, make_clock(scenario), threads);
  std::vector<std::string> told;
  actor.on_absence([&](const std::string& text) { told.push_back(text); });
  for (Tick k = 0; k <= 60; ++k) {
    const auto messages = actor.step(k, {});
    EXPECT_EQ(std::get<ObjectStates>(*messages.back().state).code[2], 0);
  }
  ASSERT_EQ(told.size(), 2u);
  EXPECT_THAT(told[0], testing::HasSubstr("falls (990000001)"));
  EXPECT_THAT(told[0], testing::HasSubstr("enters the Earth"));
  EXPECT_THAT(told[1], testing::AllOf(testing::HasSubstr("(28872)"), testing::HasSubstr("code 6")));
}

// States of some objects, for sensors that propagate what is in their field, are those of all.
TEST_F(ObjectStatesTest, StatesOfSomeObjectsAreThoseOfAll) {
  const Scenario scenario = load(all_models);
  const Clock clock = make_clock(scenario);
  Threads threads(1);
  const auto population = load_objects(scenario, clock);
  const StateSource source(population, clock, threads);
  const SimTime time = sim_seconds(30);
  const ObjectStates all = source.at(3, time);
  const std::size_t n = all.count;
  for (std::uint32_t set = 0; set < (1u << n); ++set) {
    std::vector<std::uint32_t> objects;
    for (std::uint32_t i = 0; i < n; ++i)
      if (set >> i & 1) objects.push_back(i);
    const ObjectStates some = source.of_some(objects, 3, source.instants(time));
    ASSERT_EQ(some.count, objects.size());
    for (std::size_t k = 0; k < objects.size(); ++k) {
      const std::size_t i = objects[k];
      EXPECT_EQ(some.code[k], all.code[i]);
      EXPECT_TRUE(some.position(k) == all.position(i) && some.slope(k) == all.slope(i));
      EXPECT_EQ(some.velocity_m_per_s[k], all.velocity_m_per_s[i]);
      ASSERT_EQ(some.attitude(k).has_value(), all.attitude(i).has_value());
      if (const auto attitude = some.attitude(k)) {
        EXPECT_TRUE(attitude->gcrs_from_body == all.attitude(i)->gcrs_from_body);
        EXPECT_TRUE(attitude->rate_rad_per_s == all.attitude(i)->rate_rad_per_s);
      }
    }
  }
}

// Without subscribers outside, states are published where a node of the scenario takes them.
TEST_F(ObjectStatesTest, StatesArePublishedOnlyWhereSomebodyTakesThem) {
  Threads threads(1);
  const auto topics = [&](bool publish_states, bool sensors_propagate, bool positions) {
    Scenario scenario = load(all_models);
    scenario.network.publish_states = publish_states;
    scenario.network.sensors_propagate = sensors_propagate;
    scenario.output.positions_csv = positions;
    OrbitActor actor(scenario, make_clock(scenario), threads);
    std::vector<std::string> used;
    for (Tick tick = 0; tick < 2; ++tick)
      for (const auto& message : actor.step(tick, {})) used.push_back(message.topic);
    for (const auto& topic : used) EXPECT_THAT(actor.produces(), testing::Contains(topic));
    return used;
  };
  const std::string roster = roster_topic, states = objects_topic;
  // The roster precedes the states on their topic as well.
  const std::vector<std::string> alone{roster}, both{roster, states, states, states};
  EXPECT_EQ(topics(false, true, false), alone);
  EXPECT_EQ(topics(true, true, false), both);
  EXPECT_EQ(topics(false, false, false), both);
  EXPECT_EQ(topics(false, true, true), both);
}

}  // namespace
}  // namespace dmise
