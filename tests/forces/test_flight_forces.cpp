#include "core/forces/flight_forces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

using Sunlight = FlightForces::Sunlight;

class FlightForcesTest : public testing::Test {
 protected:
  Vec<Gcrs> difference(const FlightForceSettings& with, const FlightForceSettings& without,
                       const Vec<Gcrs>& r, const Vec<Gcrs>& v = {0, 0, 0}) const {
    return FlightForces(around_, with).acceleration_m_per_s2(600, r, v) -
           FlightForces(around_, without).acceleration_m_per_s2(600, r, v);
  }

  const Clock clock_{parse_utc("2024-06-20T00:00:00")};
  const std::shared_ptr<const EarthSurroundings> around_ =
      std::make_shared<const EarthSurroundings>(clock_, -3600.0, 4 * 3600.0);
  const Vec<Gcrs> sun_ = solar_system(clock_.tt(sim_seconds(600))).sun_m;
};

// Reference: ERFA at the instant itself.
TEST_F(FlightForcesTest, SurroundingsBetweenNodesAreThoseOfErfa) {
  for (const double t : {-3000.0, 0.0, 1800.0, 7777.0}) {
    const SimTime time = sim_seconds(t);
    const EarthSurroundings::At now = around_->at(t);
    const SolarSystem bodies = solar_system(clock_.tt(time));
    EXPECT_LT(norm(now.sun_m - bodies.sun_m), 10e3);
    EXPECT_LT(norm(now.moon_m - bodies.moon_m), 10);
    const auto exact = earth_orientation(clock_, time).itrs_from_gcrs(time);
    const Vec<Gcrs> place{7e6, 0, 3e6};
    EXPECT_LT(norm(now.itrs_from_gcrs * place - exact * place), 2e-3);
  }
}

// Reference: 1361 W/m^2 over c at 1 au, 4539.8 nN/m^2.
TEST_F(FlightForcesTest, SunlightPressesAwayFromTheSunUnlessTheEarthIsBefore) {
  const FlightForceSettings none{.gravity_degree = 0, .sun_moon = false};
  const FlightForceSettings light{
      .gravity_degree = 0, .sun_moon = false, .radiation_m2_per_kg = 0.02};
  const Vec<Gcrs> to_sun = unit(sun_);
  const Vec<Gcrs> push = difference(light, none, to_sun * 42e6);
  const double distance_au = norm(sun_ - to_sun * 42e6) / au_m;
  EXPECT_NEAR(dot(push, to_sun) * 1e9, -0.02 * 4539.8 / (distance_au * distance_au), 0.01);
  EXPECT_LT(norm(push + to_sun * norm(push)), 1e-3 * norm(push));
  EXPECT_EQ(norm(difference(light, none, to_sun * -42e6)), 0);
  EXPECT_EQ(norm(difference(light, none, to_sun * 1e6)), 0);  // within the Earth
}

TEST_F(FlightForcesTest, PenumbraIsBetweenLightAndShadow) {
  const FlightForces forces(around_, {.radiation_m2_per_kg = 0.02});
  const Vec<Gcrs> away = unit(sun_) * -42164e3;
  const Vec<Gcrs> across = unit(cross(sun_, Vec<Gcrs>{0, 0, 1}));
  EXPECT_EQ(forces.sunlight(600, away), Sunlight::none);
  // The umbra's radius at GEO is 6378 km - 42164 km x 0.0046, the penumbra's 6378 km + as much.
  EXPECT_EQ(forces.sunlight(600, away + across * 6150e3), Sunlight::none);
  EXPECT_EQ(forces.sunlight(600, away + across * 6378e3), Sunlight::penumbra);
  EXPECT_EQ(forces.sunlight(600, away + across * 6600e3), Sunlight::full);
  EXPECT_EQ(FlightForces(around_, {}).sunlight(600, away), Sunlight::not_felt);
}

// Reference: Montenbruck & Gill 2000, figure 3.1: the tides' attraction in low orbits is some 1e-7
// m/s^2 and less; towards the Moon and away from it the bulge pulls down.
TEST_F(FlightForcesTest, TidesPullTowardsTheirBulges) {
  const Vec<Gcrs> moon = unit(moon_m(clock_.tt(sim_seconds(600))));
  const FlightForceSettings on{.gravity_degree = 2}, off{.gravity_degree = 0};
  const FlightForceSettings on_alone{.gravity_degree = 2, .sun_moon = false},
      off_alone{.gravity_degree = 0, .sun_moon = false};
  const Vec<Gcrs> r = moon * 7e6;
  const Vec<Gcrs> tide = difference(on, off, r) - difference(on_alone, off_alone, r);
  EXPECT_LT(dot(tide, moon), -1e-7);
  EXPECT_LT(norm(tide), 1e-6);
}

}  // namespace
}  // namespace dmise
