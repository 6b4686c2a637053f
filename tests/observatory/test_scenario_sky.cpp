// Where a scenario's stars are seen over a site: tests/reference/observatory_sky.py, by ERFA.
#include "sensors/observatory/scenario_sky.h"

#include <gtest/gtest.h>

#include "core/config/make_clock.h"
#include "tests/observatory/small_scenario.h"

namespace dmise {
namespace {

constexpr double arcsec_rad = deg / 3600.0;

TEST(ScenarioSky, SeesStarsWhereErfaDoes) {
  const Scenario scenario = small_observatory(testing::TempDir() + "/sky.yaml");
  const ScenarioSky sky(scenario, scenario.sensors[0], make_clock(scenario));
  struct Seen {
    double t_s, ra_deg, dec_deg, azimuth_rad, elevation_rad;
  };
  for (const Seen& s : {Seen{0, 80.0, 20.0, 1.7935670745, 0.9183130910},
                        Seen{14400, 80.0, 20.0, 4.1394106747, 1.1569177424},
                        Seen{14400, 130.0, -5.0, 2.4402179099, 0.7299507798},
                        Seen{0, 37.95456067, 89.26410897, 0.0006291253, 0.6178921255}}) {
    const SimTime t = sim_seconds(s.t_s);
    const Vec<Enu> erfa = direction_of(Horizontal{s.azimuth_rad, s.elevation_rad});
    const Vec<Enu> seen = sky.seen({s.ra_deg, s.dec_deg}, t);
    EXPECT_LT(angle_rad(seen, erfa), 0.1 * arcsec_rad) << s.ra_deg << " at " << s.t_s;
    const Equatorial back = sky.star_seen_at(seen, t);
    EXPECT_NEAR(back.ra_deg, s.ra_deg, 1e-7);
    EXPECT_NEAR(back.dec_deg, s.dec_deg, 1e-9);
  }
  EXPECT_NEAR(sky.sidereal_time_rad({}), 0.718900041500, 1e-9);
  EXPECT_NEAR(sky.sidereal_time_rad(sim_seconds(14400)), 1.768964679005, 1e-9);
}

}  // namespace
}  // namespace dmise
