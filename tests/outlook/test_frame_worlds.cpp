#include "sensors/outlook/frame_worlds.h"

#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

/// The environment within an exposure of half a second, by ticks of this length.
EnvironmentState within_exposure(double tick_s) {
  const test::Stage stage(
      "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 1, tick_s: 1, seed: 1}\n"
      "sensors: [{name: eye, site: savannah, camera: geo-watch, pointing: zenith, "
      "exposure_s: 0.5, cadence_s: 1}]\n");
  Scenario scenario = stage.scenario;
  scenario.tick = sim_seconds(tick_s);
  const Clock clock = make_clock(scenario);
  Threads threads(1);
  const ObjectPopulation none;
  FrameWorlds worlds(scenario, scenario.sensors[0], clock);
  const World world =
      worlds.around(frame_times(scenario.sensors[0], 1), none, StateSource(none, clock, threads));
  const SimTime instant{456'700'000};
  EXPECT_NE(world.site("eye", instant), nullptr);
  return world.environment(instant);
}

// Between environments Sun, Moon and Earth run on by their rates: one at each of the many short
// ticks in an exposure would take minutes and change nothing.
TEST(FrameWorlds, HaveTheSameSkyByShortTicksWithFewEnvironments) {
  const EnvironmentState coarse = within_exposure(0.1), fine = within_exposure(1e-4);
  EXPECT_EQ(coarse.tick, 4);
  EXPECT_EQ(fine.tick, 4000);
  EXPECT_NEAR(norm(fine.sun_m - coarse.sun_m), 0.0, 0.01);
  EXPECT_NEAR(norm(fine.moon_m - coarse.moon_m), 0.0, 0.01);
}

}  // namespace
}  // namespace dmise
