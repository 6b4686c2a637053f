#include "sensors/objects/states_in_field.h"

#include <gtest/gtest.h>

#include "tests/pipeline/harness.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

/// A window whose ticks have no states, of the same scene as a stage's.
StateWindow without_states(const test::Stage& stage, const PropagatedObjects& objects) {
  StateWindow window(stage.scenario.interpolation, stage.scenario.last_tick());
  window.add(std::make_shared<const ObjectRoster>(objects.population.roster));
  EnvironmentActor environment(stage.scenario, make_clock(stage.scenario));
  for (Tick tick = 0; tick <= stage.scenario.last_tick(); ++tick) {
    window.add_tick(tick, stage.scenario.time_of(tick));
    for (const auto& message : environment.step(tick, {})) {
      if (const auto* state = std::get_if<EnvironmentState>(message.state.get()))
        window.add(std::make_shared<const EnvironmentState>(*state));
      if (const auto* state = std::get_if<SiteState>(message.state.get()))
        window.add(std::make_shared<const SiteState>(*state));
    }
  }
  return window;
}

std::string scene(const std::string& simulation, const std::string& sensor, double exposure_s,
                  const std::string& own = "") {
  const std::string length = std::to_string(exposure_s);
  return "simulation: {start: 2018-01-21T00:15:00Z, " + simulation +
         "}\n"
         "objects:\n  - {catalogue: demo}\n" +
         own + "sensors: [{name: a, " + sensor + ", exposure_s: " + length +
         ", cadence_s: " + length + "}]\n";
}

/// Compares what a sensor finds and where, frame by frame, by published and by own states. Returns
/// the share of the objects that it propagates.
double expect_same_field(const std::string& yaml, std::size_t least_found) {
  SCOPED_TRACE(yaml);
  test::Stage stage(yaml);
  const Clock clock = make_clock(stage.scenario);
  const auto population = load_objects(stage.scenario, clock);
  const auto objects = std::make_shared<const PropagatedObjects>(published_roster(population),
                                                                 stage.scenario.own_objects, clock,
                                                                 stage.scenario.earth.ellipsoid);
  const StateWindow empty = without_states(stage, *objects);
  StatesInField states(objects, stage.scenario.tick);
  const auto& sensor = stage.scenario.sensors[0];
  std::size_t all = 0, known = 0;
  for (std::uint32_t frame = 1; frame <= frames_within(sensor, stage.scenario.duration); ++frame) {
    const FrameTimes times = frame_times(sensor, frame);
    const StateWindow own = states.around(empty, sensor, times);
    const View by_published(sensor, times, stage.states), by_own(sensor, times, own);
    const auto found = objects_in_field(by_published);
    EXPECT_EQ(objects_in_field(by_own), found) << frame;
    all += found.size();
    for (const std::size_t i : found)
      for (const double share : {0.0, 0.31, 0.5, 1.0}) {
        const SimTime t = times.at(share);
        const Motion a = stage.states.motion(i, t), b = own.motion(i, t);
        EXPECT_TRUE(a.position_m == b.position_m && a.slope_m_per_s == b.slope_m_per_s) << i;
        EXPECT_TRUE(stage.states.gcrs_from_body(i, t).has_value() ==
                    own.gcrs_from_body(i, t).has_value());
      }
    EXPECT_TRUE(own.restricted_to());
    if (!own.restricted_to()) continue;
    known += own.restricted_to()->size();
  }
  EXPECT_GE(all, least_found);
  return double(known) / double(objects->population.roster.objects.size()) /
         frames_within(sensor, stage.scenario.duration);
}

const std::string atlanta = "site: {latitude_deg: 33.8, longitude_deg: -84.4, height_m: 300}, ";

// 979 real element sets: every order, short and long ticks and exposures, cameras that stay, follow
// the stars or a satellite, from the ground and from orbit, fields from 0.1 deg to the whole sky.
TEST(StatesInField, ASensorFindsTheSameObjectsAtTheSamePlacesByItsOwnStates) {
  const std::string all_sky = atlanta + "camera: omnissa, pointing: zenith",
                    telescope = atlanta + "camera: raven, pointing: ",
                    imager = "platform: '25544', camera: geo-watch, pointing: {tracking: fixed}";
  expect_same_field(scene("duration_s: 60, tick_s: 5", all_sky, 20), 20);
  for (const char* order : {"3", "5", "7"})
    expect_same_field(
        scene("duration_s: 240, tick_s: 30, interpolation: " + std::string(order), all_sky, 7.5),
        20);
  const double share =
      expect_same_field(scene("duration_s: 1200, tick_s: 10",
                              telescope + "{ra_deg: 30, dec_deg: -5, tracking: sidereal}", 20),
                        0);
  EXPECT_LT(share, 0.02);  // the field is 0.0001 of the sky
  // Shortlists of several spans of rough places, of a camera that turns with the Earth.
  expect_same_field(scene("duration_s: 1200, tick_s: 10",
                          atlanta + "camera: geo-watch, pointing: {azimuth_deg: 180, "
                                    "elevation_deg: 50}",
                          20),
                    10);
  for (const double exposure_s : {0.5, 62.0, 899.0})
    expect_same_field(scene("duration_s: 1798, tick_s: 31", imager, exposure_s), 0);
  expect_same_field(scene("duration_s: 62, tick_s: 31",
                          "site: {latitude_deg: -16.433, longitude_deg: -105.204, height_m: 0}, "
                          "camera: wide-field-cmos, pointing: {target: '25544', tracking: target}",
                          31),
                    1);
}

// Objects of the scenario's own, whatever moves them, have no rough places: they are always known.
TEST(StatesInField, OwnObjectsOfEveryMotionAreFound) {
  const std::string own = R"(
  - {name: kepler, attitude: nadir, motion: {two_body: {semi_major_axis_m: 7.0e6,
     eccentricity: 0.02, inclination_deg: 60, raan_deg: 40, true_anomaly_deg: 30}}}
  - {name: near, motion: {fixed: {latitude_deg: 33.81, longitude_deg: -84.4, height_m: 30000}}}
  - name: elements
    attitude: {inertial: {gcrs_from_body: [0.5, 0.5, -0.5, 0.5]}}
    motion:
      sgp4:
        line1: 1 29155U 06018A   18020.76993589 -.00000277  00000-0  00000+0 0  9990
        line2: 2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737
)";
  expect_same_field(
      scene("duration_s: 40, tick_s: 5", atlanta + "camera: omnissa, pointing: zenith", 20, own),
      20);
}

// A roster of another scenario is refused by name instead of giving states of other objects.
TEST(StatesInField, ARosterOfAnotherScenarioIsRefused) {
  ObjectRoster roster{.objects = {{.catalogue_number = 5, .name = "VANGUARD 1"}}, .elements = {{}}};
  EXPECT_NO_THROW(population_of(roster, {}));
  OwnObject own{.name = "mast"};
  own.motion.model = MotionModel(ConstantPosition<Itrs>{{7e6, 0, 0}});
  EXPECT_THROW(population_of(roster, {own}), Error);
  roster.objects.push_back({.catalogue_number = 6, .name = "another"});
  EXPECT_THROW(population_of(roster, {own}), Error);
  roster.objects[1].name = "mast";
  EXPECT_NO_THROW(population_of(roster, {own}));
}

}  // namespace
}  // namespace dmise
