#include <gtest/gtest.h>

#include "core/sky/places/apparent.h"
#include "core/sky/places/place_effects.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

struct Row {
  Vec<Gcrs> position_m, velocity_m_per_s, observer_m, observer_m_per_s;
  double light_time_s;
  Vec<Gcrs> astrometric, seen;

  // The reference's circular orbit.
  Vec<Gcrs> at(double dt_s) const {
    const double rate = norm(velocity_m_per_s) / norm(position_m);
    return position_m * std::cos(rate * dt_s) + velocity_m_per_s * (std::sin(rate * dt_s) / rate);
  }
};

const Row rows[] = {
#include "tests/sky/apparent_satellites_reference.inc"
};

const Tt tt{2458139.5, 0.0};

EffectSet without(const EffectFacts& effect) {
  EffectSet effects;
  effects.set(effect, false);
  return effects;
}

// Reference: ERFA's eraAb and an orbit in numpy, tests/reference/apparent_satellites.py.
TEST(ApparentSatellites, AgreeWithErfaFromTheGroundAndFromSpace) {
  for (const Row& row : rows) {
    const ApparentPlaces places(
        space_observer(row.observer_m, row.observer_m_per_s, tt, solar_system(tt)), {});
    const SatellitePlace place = places.satellite([&](double dt_s) { return row.at(dt_s); });
    EXPECT_LT(angle_rad(place.astrometric, row.astrometric), 1e-3 * mas);
    EXPECT_LT(angle_rad(place.direction, row.seen), 1e-3 * mas);
    EXPECT_NEAR(place.light_time_s, row.light_time_s, 1e-12);
    EXPECT_NEAR(place.range_m, norm(row.position_m - row.observer_m), 1e-6);
    // A straight path over one light time is enough.
    const SatellitePlace straight = places.satellite(row.position_m, row.velocity_m_per_s);
    EXPECT_LT(angle_rad(straight.direction, row.seen), 0.1 * mas);
  }
}

TEST(ApparentSatellites, AnnualAberrationDoesNotApply) {
  const Row& row = rows[0];
  const Observer observer =
      space_observer(row.observer_m, row.observer_m_per_s, tt, solar_system(tt));
  EXPECT_EQ(ApparentPlaces(observer, {}).satellite(row.position_m, row.velocity_m_per_s).direction,
            ApparentPlaces(observer, without(AnnualAberration::facts))
                .satellite(row.position_m, row.velocity_m_per_s)
                .direction);
}

// Light time shifts by the satellite's transverse velocity over that of light: 5.2 arcsec at 7.5
// km/s whatever the range, 2.1 at GEO; an observer in low orbit is aberrated by as much.
TEST(ApparentSatellites, LightTimeAndAberrationHaveTheirSizes) {
  const Observer centre = space_observer({0, 0, 0}, {0, 7500, 0}, tt, solar_system(tt));
  const ApparentPlaces places(centre, {});
  for (const double range : {1e3, 1e6, 4.2e7}) {
    const SatellitePlace p = places.satellite({range, 0, 0}, {0, 7500, 0});
    EXPECT_NEAR(angle_rad(p.astrometric, {1, 0, 0}), 5.16 * arcsec, 0.01 * arcsec);
    EXPECT_NEAR(angle_rad(p.aberrated, p.astrometric), 5.16 * arcsec, 0.01 * arcsec);
    // Who moves along with it sees it where it is.
    EXPECT_LT(angle_rad(p.direction, {1, 0, 0}), 0.01 * mas);
  }
  EXPECT_NEAR(angle_rad(places.satellite({4.2e7, 0, 0}, {0, 3075, 0}).astrometric, {1, 0, 0}),
              2.1 * arcsec, 0.05 * arcsec);
  const SatellitePlace still =
      ApparentPlaces(centre, without(LightTime::facts)).satellite({1e6, 0, 0}, {0, 7500, 0});
  EXPECT_EQ(still.astrometric, (Vec<Gcrs>{1, 0, 0}));
  EXPECT_EQ(still.light_time_s, 0.0);
}

// Reference: rays traced through the standard atmosphere, tests/reference/refraction.py.
TEST(ApparentSatellites, AreLiftedByTheAirLessThanStars) {
  const Clock clock(parse_utc("2018-01-20T23:40:00Z"));
  const Observer here =
      ground_observer({0.0, 0.0, 0.0}, earth_orientation(clock, {}), {}, clock.tt({}),
                      solar_system(clock.tt({})), Refraction(standard_weather(0.0)));
  const ApparentPlaces places(here, {});
  const Vec<Gcrs> side = unit(cross(here.air->zenith, {0, 0, 1}));
  const auto lift = [&](double zenith_deg, double distance_m) {
    const Vec<Gcrs> line =
        here.air->zenith * std::cos(zenith_deg * deg) + side * std::sin(zenith_deg * deg);
    const SatellitePlace p = places.satellite(here.position_m + line * distance_m, {});
    return angle_rad(p.direction, p.aberrated);
  };
  EXPECT_NEAR(lift(45, 1e12) - lift(45, 750e3), 0.906 * arcsec, 0.02 * arcsec);
  EXPECT_NEAR(lift(80, 1e12) - lift(80, 1830e3), 7.7 * arcsec, 0.3 * arcsec);
  EXPECT_LT(lift(0, 550e3), 1 * mas);
}

TEST(ApparentSatellites, AtTheObserverIsAnError) {
  const ApparentPlaces places(space_observer({7e6, 0, 0}, {0, 7500, 0}, tt, solar_system(tt)), {});
  EXPECT_THROW(places.satellite({7e6, 0, 0}, {0, 7500, 0}), std::runtime_error);
}

}  // namespace
}  // namespace dmise
