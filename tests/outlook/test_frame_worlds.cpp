#include "sensors/outlook/frame_worlds.h"

#include "core/sky/sun_moon.h"
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
  FrameWorlds worlds(scenario, scenario.sensors[0], clock);
  const World world =
      worlds.around(frame_times(scenario.sensors[0], 1), none, StateSource(none, clock, threads));
  EXPECT_NE(world.site("eye", instant), nullptr);
  const EnvironmentState environment = world.environment(instant);
  const SolarSystem true_bodies = solar_system(clock.tt(instant));
  return {environment, norm(environment.sun_m - true_bodies.sun_m),
          norm(environment.moon_m - true_bodies.moon_m)};
}

// Between environments Sun, Moon and Earth run on by their rates: one at each of the many short
// ticks in an exposure would take minutes and change nothing.
TEST(FrameWorlds, HaveTheSameSkyByShortTicksWithFewEnvironments) {
  const Within coarse = within_exposure(0.1), fine = within_exposure(1e-4);
  EXPECT_EQ(coarse.environment.tick, 4);
  EXPECT_EQ(fine.environment.tick, 4000);  // not 4567: there is none at each tick
  for (const Within& w : {coarse, fine}) {
    EXPECT_LT(w.sun_off_m, 1.5);  // 13 m/s about the barycentre are left out
    EXPECT_LT(w.moon_off_m, 0.01);
  }
}

}  // namespace
}  // namespace dmise
