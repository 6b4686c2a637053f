#include <gmock/gmock.h>

#include <cmath>

#include "core/base/files/user_directories.h"
#include "core/base/units.h"
#include "core/sky/places/place_effects.h"
#include "core/sky/places/sun_moon.h"
#include "core/sky/stars/star_cache.h"
#include "sensors/frame/make_sensor.h"
#include "tests/pipeline/harness.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

std::string scenario(const std::string& environment, const std::string& sensors) {
  return "simulation: {start: 2018-01-21T04:00:00Z, duration_s: 300, tick_s: 10}\n" + environment +
         "sensors:\n" + sensors;
}
const std::string ground =
    "  - {name: a, site: atlanta, camera: geo-watch, pointing: zenith, exposure_s: 5, cadence_s: "
    "10";

TEST(Environment, TellsTheSkyEveryTickAndTheAirAtItsOwnRate) {
  test::Stage stage(scenario("environment: {site_every_s: 45}\n", ground + "}\n"));
  EnvironmentActor actor(stage.scenario, make_clock(stage.scenario));
  EXPECT_THAT(actor.produces(), testing::ElementsAre("env/common", "env/site/a"));
  std::vector<Tick> common, site;
  for (Tick tick = 0; tick <= 12; ++tick)
    for (const auto& message : actor.step(tick, {}))
      (message.topic == "env/common" ? common : site).push_back(message.tick);
  EXPECT_EQ(common.size(), 13u);
  EXPECT_THAT(site, testing::ElementsAre(0, 5, 10));  // 45 s are five ticks of 10 s
}

// Told once an hour, the bodies go on moving: against ERFA's eraEpv00 and eraMoon98 at the time
// itself. Held, the Moon would be 0.5 deg off. And nothing jumps where the next state is told.
TEST(Environment, GoesOnBetweenTwoStates) {
  const auto told = [](const std::string& every) {
    return "simulation: {start: 2018-01-28T04:00:00Z, duration_s: 7200, tick_s: 60}\n" + every +
           "sensors:\n" + ground + "}\n";
  };
  test::Stage stage(told("environment: {common_every_s: 3600}\n"));
  const Clock clock = make_clock(stage.scenario);
  for (const double t_s : {0.0, 30.0, 1800.0, 3480.0, 3599.9, 3600.0, 7190.0}) {
    const SimTime t = sim_seconds(t_s);
    const EnvironmentState state = stage.states.environment(t);
    const SolarSystem exact = solar_system(clock.tt(t));
    EXPECT_LT(angle_rad(state.sun_m, exact.sun_m), 0.1 * arcsec) << t_s;
    EXPECT_LT(angle_rad(state.moon_m, exact.moon_m), 1.0 * arcsec) << t_s;
    EXPECT_LT(norm(state.moon_m - exact.moon_m), 3e3) << t_s;
    EXPECT_LT(norm(state.earth_velocity_m_per_s - exact.earth_velocity_m_per_s), 1e-2) << t_s;
    EXPECT_NEAR(days_between(Tt{state.tt_jd1, state.tt_jd2}, clock.tt(t)), 0.0, 1e-9) << t_s;
  }
  const auto before = stage.states.environment(sim_seconds(3599.999));
  const auto after = stage.states.environment(sim_seconds(3600));
  EXPECT_LT(angle_rad(before.moon_m, after.moon_m), 1.0 * arcsec);
}

// Programs of the user's hear of the ephemeris at whole minutes, run on: against ERFA at the ticks.
TEST(Environment, ByMinutesIsThatOfTheTick) {
  for (const char* start : {"1972-06-30T23:59:30Z", "2018-01-28T04:00:00Z", "2016-12-31T23:59:00Z",
                            "2049-10-03T11:00:00Z"}) {
    test::Stage stage(std::string("simulation: {start: ") + start +
                      ", duration_s: 300, tick_s: 10}\nsensors:\n" + ground + "}\n");
    const Clock clock = make_clock(stage.scenario);
    EnvironmentByMinutes minutes(clock);
    for (const double t_s : {0.0, 0.1, 59.9, 60.0, 61.0, 119.999, 3599.0, 86359.5, 30.0}) {
      const SimTime t = sim_seconds(t_s);
      const EnvironmentState state = minutes.at(7, t), exact = environment_at(clock, 7, t);
      EXPECT_EQ(state.tick, 7);
      EXPECT_EQ(state.time, t);
      EXPECT_EQ(state.earth.time, t);
      EXPECT_LT(angle_rad(state.sun_m, exact.sun_m), 0.002 * arcsec) << t_s;
      EXPECT_LT(angle_rad(state.moon_m, exact.moon_m), 0.002 * arcsec) << t_s;
      EXPECT_LT(norm(state.earth_velocity_m_per_s - exact.earth_velocity_m_per_s), 1e-3) << t_s;
      const Vec<Gcrs> x{1, 0, 0}, z{0, 0, 1};
      for (const Vec<Gcrs>& axis : {x, z})
        EXPECT_LT(
            angle_rad(state.earth.itrs_from_gcrs(t) * axis, exact.earth.itrs_from_gcrs(t) * axis),
            0.0002 * arcsec)
            << t_s;
      EXPECT_NEAR(std::remainder(state.earth.gmst82_rad - exact.earth.gmst82_rad, 2 * pi), 0.0,
                  1e-9)
          << t_s;
    }
    EXPECT_EQ(minutes.at(6, sim_seconds(60)).sun_m,
              environment_at(clock, 6, sim_seconds(60)).sun_m);
  }
}

// The 5/7 model: r0 4.96 cm and an isoplanatic angle of 6.89 urad at 0.5 um. The frame says so too.
TEST(Environment, TellsTheTurbulenceOfASite) {
  test::Stage stage(scenario("", ground + ", atmosphere: {turbulence: hv57}}\n"));
  const SiteState* air = stage.states.site("a", {});
  ASSERT_TRUE(air);
  EXPECT_NEAR(air->r0_m, 0.0496, 0.005 * 0.0496);
  EXPECT_NEAR(air->isoplanatic_angle_rad, 6.89e-6, 0.005 * 6.89e-6);
  EXPECT_NEAR(air->tau0_s * air->turbulence_m_per_s, air->r0_m, 1e-12);
  const auto frame = stage.frame();
  EXPECT_EQ(frame.header.r0_m, air->r0_m);
  EXPECT_EQ(frame.header.tau0_s, air->tau0_s);
}

TEST(Environment, ASensorAsksForWhatItsPlanNeeds) {
  std::string plain = ground;
  plain.replace(plain.find("name: a"), 7, "name: b");
  test::Stage stage(
      scenario("", ground + "}\n" + plain +
                       ", effects: {objects: off, sky: off, extinction: off, refraction: off}}\n"));
  Threads one(1);
  const auto consumes = [&](const char* name) {
    return make_sensor(stage.scenario, name, "", stage.directory / "out", nullptr, one)->consumes();
  };
  EXPECT_THAT(consumes("a"), testing::ElementsAre("state/roster", "env/common", "env/site/a"));
  EXPECT_THAT(consumes("b"), testing::ElementsAre("env/common"));
}

TEST(Stars, TheCacheIsKeptInTheUsersDirectoryAlsoTheFirstTime) {
  test::Stage stage(
      "simulation: {start: 2018-01-21T04:00:00Z, duration_s: 300, tick_s: 10}\n"
      "stars: {catalogue: stars.csv}\nsensors:\n" +
          ground + "}\n",
      "ra_deg,dec_deg,mag_v\n0,90,6\n");
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before ? before : "";
  setenv("XDG_CACHE_HOME", (stage.directory / "not/there/yet").c_str(), 1);
  EXPECT_FALSE(load_stars(stage.scenario)->from_cache);
  const std::string& catalogue = stage.scenario.star_catalogue_path;
  EXPECT_TRUE(load_star_map(catalogue, cache_directory()).from_cache);
  before ? setenv("XDG_CACHE_HOME", kept.c_str(), 1) : unsetenv("XDG_CACHE_HOME");
}

// What the weather says bends the light: none without air.
TEST(Environment, RefractionIsThatOfTheSitesWeather) {
  const auto lift = [](const std::string& weather) {
    test::Stage stage(scenario("", ground + weather + "}\n"));
    const auto& config = stage.scenario.sensors[0];
    const View view(config, frame_times(config, 1), stage.states);
    const SimTime t = view.times().middle;
    const Vec<Gcrs> low = view.enu_from_gcrs(t).inverse() * from_horizontal({1.0, 20 * deg});
    const auto [ra, dec] = to_spherical(low);
    EffectSet none = config.effects;
    none.set(AtmosphericRefraction::facts, false);
    const StarPlace star{.ra_rad = ra, .dec_rad = dec};
    return angle_rad(view.places(t).star(star), view.places(t, none).star(star)) / arcsec;
  };
  EXPECT_NEAR(lift(", weather: {pressure_hpa: 0}"), 0.0, 1e-9);
  EXPECT_NEAR(lift(", weather: {pressure_hpa: 500, temperature_c: 15}") /
                  lift(", weather: {pressure_hpa: 1000, temperature_c: 15}"),
              0.5, 0.005);
}

}  // namespace
}  // namespace dmise
