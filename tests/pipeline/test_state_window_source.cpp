#include "sensors/objects/state_window_source.h"

#include "core/sky/places/sun_moon.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

constexpr SimTime instant{456'700'000};

/// The environment within an exposure of half a second, by ticks of this length, and how far Sun
/// and Moon are from where the ephemeris has them then.
struct Within {
  EnvironmentState environment;
  double sun_off_m, moon_off_m;
};

Within within_exposure(double tick_s) {
  const test::Stage stage(
      "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 1, tick_s: 1, seed: 1}\n"
      "sensors: [{name: eye, site: savannah, camera: geo-watch, pointing: zenith, "
      "exposure_s: 0.5, cadence_s: 1}]\n");
  Scenario scenario = stage.scenario;
  scenario.tick = sim_seconds(tick_s);
  const Clock clock = make_clock(scenario);
  Threads threads(1);
  const ObjectPopulation none;
  const StateWindowSource windows(scenario, scenario.sensors[0], clock, close_environments_s);
  const StateWindow window =
      windows.around(frame_times(scenario.sensors[0], 1), none, StateSource(none, clock, threads));
  EXPECT_NE(window.site("eye", instant), nullptr);
  const EnvironmentState environment = window.environment(instant);
  const SolarSystem true_bodies = solar_system(clock.tt(instant));
  return {environment, norm(environment.sun_m - true_bodies.sun_m),
          norm(environment.moon_m - true_bodies.moon_m)};
}

// Between environments Sun, Moon and Earth run on by their rates: one at each of the many short
// ticks in an exposure would take minutes and change nothing.
TEST(StateWindowSource, HasTheSameSkyByShortTicksWithFewEnvironments) {
  const Within coarse = within_exposure(0.1), fine = within_exposure(1e-4);
  EXPECT_EQ(coarse.environment.tick, 4);
  EXPECT_EQ(fine.environment.tick, 4000);  // not 4567: there is none at each tick
  for (const Within& w : {coarse, fine}) {
    EXPECT_LT(w.sun_off_m, 1.5);  // 13 m/s about the barycentre are left out
    EXPECT_LT(w.moon_off_m, 0.01);
  }
}

// A window that is computed gives the frame that the messages of the nodes give, to the bit: where
// the environment is published seldom, and ticks do not divide the exposures.
TEST(StateWindowSource, IsWhatTheNodesPublish) {
  for (const int order : {3, 7}) {
    test::Stage stage(
        "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 40, tick_s: 0.7, seed: 3, "
        "interpolation: " +
        std::to_string(order) +
        "}\n"
        "environment: {common_every_s: 5, site_every_s: 9}\n"
        "objects: [{catalogue: demo}]\n"
        "sensors: [{name: eye, site: savannah, camera: omnissa, pointing: zenith, "
        "exposure_s: 6, cadence_s: 8}]\n");
    const SensorConfig& sensor = stage.scenario.sensors[0];
    const Clock clock = make_clock(stage.scenario);
    const ObjectPopulation population = load_objects(stage.scenario, clock);
    const StateSource states(population, clock, stage.threads);
    const StateWindowSource windows(stage.scenario, sensor, clock);
    const StateWindow published = stage.states;
    for (const std::uint32_t number : {1u, 4u}) {
      const FrameTimes times = frame_times(sensor, number);
      stage.states = published;
      const FrameProducts frame = stage.frame(number);
      EXPECT_GE(frame.truths.size(), 5u);
      for (const StateWindow& window :
           {windows.around(times, population, states), windows.until(times, population, states)}) {
        stage.states = window;
        EXPECT_EQ(stage.frame(number).counts.pixels, frame.counts.pixels) << order << " " << number;
      }
    }
  }
}

}  // namespace
}  // namespace dmise
