#include "core/tracking/initial/admissible_region.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/orbit/two_body.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

std::vector<AngleObservation> short_arc(int count, double step_s, const OrbitState& truth) {
  const ForceModel two_body(ForceSettings{.zonals = 0});
  std::vector<AngleObservation> out;
  for (int i = 0; i < count; ++i) {
    const SimTime time = sim_seconds(i * step_s);
    AngleObservation o = observe(two_body, truth, time, turned_site(0.4, 0.1, time));
    o.covariance_rad2 = {2.35e-11, 0, 2.35e-11};
    out.push_back(o);
  }
  return out;
}

OrbitState low_orbit() { return {SimTime{}, {6.6e6, 7e5, 3.1e6}, {-2e3, 6.3e3, 3e3}}; }

TEST(Tracklet, HasTheRateOfTheObject) {
  const auto arc = short_arc(5, 2.0, low_orbit());
  const auto tracklet = tracklet_of(arc);
  ASSERT_TRUE(tracklet) << tracklet.reason;
  EXPECT_EQ(tracklet->time, sim_seconds(4.0));
  const Vec<Gcrs> expected = (arc[3].direction - arc[1].direction) / 4.0;
  EXPECT_LT(norm(tracklet->rate_rad_per_s - expected), 1e-3 * norm(expected));
  EXPECT_NEAR(dot(tracklet->rate_rad_per_s, tracklet->direction), 0, 1e-12);
  // A site turns with the Earth.
  const double speed = 7.292115146706979e-5 * std::hypot(arc[2].sensor_m.x, arc[2].sensor_m.y);
  EXPECT_NEAR(norm(tracklet->sensor_m_per_s), speed, 0.01);
}

TEST(Tracklet, RefusesWhatHasNoRate) {
  auto arc = short_arc(3, 2.0, low_orbit());
  EXPECT_EQ(tracklet_of(std::span(arc).first(1)).reason, "fewer than two observations");
  arc[1].time = arc[2].time = arc[0].time;
  EXPECT_EQ(tracklet_of(arc).reason, "the observations are of one time");
  arc = short_arc(3, 2.0, low_orbit());
  arc[1].sensor = "other";
  EXPECT_EQ(tracklet_of(arc).reason, "the observations are of several sensors");
}

TEST(AdmissibleRegion, HoldsTheTruth) {
  const OrbitState truth = low_orbit();
  const auto tracklet = tracklet_of(short_arc(5, 2.0, truth));
  const auto region = admissible_region(*tracklet);
  ASSERT_TRUE(region) << region.reason;
  const TwoBodyState now =
      propagate_two_body({truth.position_m, truth.velocity_m_per_s}, tracklet->time.seconds());
  double nearest_m = 1e12;
  for (const OrbitState& state : *region) {
    nearest_m = std::min(nearest_m, norm(state.position_m - now.position_m));
    const double v2 = dot(state.velocity_m_per_s, state.velocity_m_per_s);
    EXPECT_LT(v2 / 2, earth_gm_m3_per_s2 / norm(state.position_m));
    EXPECT_GE(perigee_m(state), 6.478e6);
    EXPECT_LE(apogee_m(state), 5e7);
  }
  EXPECT_LT(nearest_m, 0.1 * norm(now.position_m - tracklet->sensor_m));
}

// At the bounds the energy is zero.
TEST(AdmissibleRegion, BoundsAreOfEnergy) {
  const auto tracklet = tracklet_of(short_arc(5, 2.0, low_orbit()));
  for (const double range_m : {3e5, 1e6, 3e6}) {
    const RangeRates rates = bound_range_rates(*tracklet, range_m);
    if (rates.empty()) continue;
    for (const double rate : {rates.min_m_per_s, rates.largest_m_per_s}) {
      const Vec<Gcrs> r = tracklet->sensor_m + range_m * tracklet->direction;
      const Vec<Gcrs> v = tracklet->sensor_m_per_s + rate * tracklet->direction +
                          range_m * tracklet->rate_rad_per_s;
      EXPECT_NEAR(dot(v, v) / 2 / (earth_gm_m3_per_s2 / norm(r)), 1, 1e-9);
    }
  }
}

TEST(AdmissibleRegion, RefusesAMeteor) {
  Tracklet tracklet = *tracklet_of(short_arc(5, 2.0, low_orbit()));
  tracklet.rate_rad_per_s = tracklet.rate_rad_per_s * 100;
  EXPECT_EQ(admissible_region(tracklet).reason,
            "no range and range rate make a bound orbit above the air");
}

}  // namespace
}  // namespace dmise
