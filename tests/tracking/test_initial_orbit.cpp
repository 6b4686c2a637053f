#include "core/tracking/initial/initial_orbit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/units.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

using Three = std::array<AngleObservation, 3>;

/// `ranges_m`: the book has no light time, so its light arrives later.
AngleObservation line(double time_s, const Vec<Gcrs>& sensor_km, double ra_deg, double dec_deg,
                      double range_m) {
  AngleObservation out;
  out.time = sim_seconds(time_s + range_m / speed_of_light_m_per_s);
  out.sensor_m = sensor_km * km;
  out.direction = from_spherical<Gcrs>(ra_deg * deg, dec_deg * deg);
  out.covariance_rad2 = {1e-14, 0, 1e-14};
  return out;
}

// Curtis, Orbital Mechanics for Engineering Students, examples 5.11 and 5.12: a site at 40 deg,
// 1 km high, on an ellipsoid of 6378 km and 0.003353. Its angles are rounded to 0.001 deg, which
// the curvature of 4 deg of arc turns into kilometres of range.
Three curtis() {
  const auto site = [](double sidereal_deg) {
    const double s = std::sin(40 * deg), c = std::cos(40 * deg), f = 0.003353;
    const double across = 6378 / std::sqrt(1 - (2 * f - f * f) * s * s);
    return Vec<Gcrs>{(across + 1) * c * std::cos(sidereal_deg * deg),
                     (across + 1) * c * std::sin(sidereal_deg * deg),
                     (across * (1 - f) * (1 - f) + 1) * s};
  };
  return {line(0, site(44.506), 43.537, -8.7833, 3639.1e3),
          line(118.10, site(45.000), 54.420, -12.074, 3864.8e3),
          line(237.58, site(45.499), 64.318, -15.105, 4172.8e3)};
}

// Vallado, Fundamentals of Astrodynamics and Applications, example 7-2.
Three vallado() {
  return {line(0, {4054.881, 2748.195, 4074.237}, 0.939913, 18.667717, 4500e3),
          line(480, {3956.224, 2888.232, 4074.364}, 45.025748, 35.664741, 4200e3),
          line(720, {3905.073, 2956.935, 4074.430}, 67.886655, 36.996583, 4600e3)};
}

/// The nearest of some states, moved to `time`.
OrbitState nearest(const std::vector<OrbitState>& states, SimTime time, const Vec<Gcrs>& place) {
  const ForceModel two_body(ForceSettings{.zonals = 0});
  OrbitState best;
  for (const OrbitState& state : states) {
    const auto moved = propagate(two_body, state, time);
    if (moved && (best.position_m == Vec<Gcrs>{} ||
                  norm(moved->position_m - place) < norm(best.position_m - place)))
      best = *moved;
  }
  return best;
}

TEST(Gauss, AgreesWithCurtis) {
  const auto orbits = gauss_orbit(curtis());
  ASSERT_TRUE(orbits) << orbits.reason;
  const Vec<Gcrs> place{5662.1e3, 6538.0e3, 3269.0e3};
  const OrbitState state = nearest(*orbits, sim_seconds(118.10), place);
  EXPECT_LT(norm(state.position_m - place), 2000);
  EXPECT_LT(norm(state.velocity_m_per_s - Vec<Gcrs>{-3885.6, 5121.4, -2243.3}), 6);
}

TEST(Gauss, AgreesWithVallado) {
  const auto orbits = gauss_orbit(vallado());
  ASSERT_TRUE(orbits) << orbits.reason;
  const Vec<Gcrs> place{6356.486e3, 5290.532e3, 6511.397e3};
  const OrbitState state = nearest(*orbits, sim_seconds(480), place);
  EXPECT_LT(norm(state.position_m - place), 5000);
  EXPECT_LT(norm(state.velocity_m_per_s - Vec<Gcrs>{-4172.948, 4776.550, 1720.271}), 5);
}

TEST(Gooding, AgreesWithCurtisAndVallado) {
  const auto curtis_orbits = gooding_orbit(curtis());
  ASSERT_TRUE(curtis_orbits) << curtis_orbits.reason;
  const Vec<Gcrs> place{5662.1e3, 6538.0e3, 3269.0e3};
  EXPECT_LT(norm(nearest(*curtis_orbits, sim_seconds(118.10), place).position_m - place), 2000);
  const auto vallado_orbits = gooding_orbit(vallado());
  ASSERT_TRUE(vallado_orbits) << vallado_orbits.reason;
  const Vec<Gcrs> other{6356.486e3, 5290.532e3, 6511.397e3};
  EXPECT_LT(norm(nearest(*vallado_orbits, sim_seconds(480), other).position_m - other), 5000);
}

/// Lines without error from one site in the plane of the orbit, or beside it.
Three lines_from(const ForceModel& forces, const OrbitState& truth, const Vec<Gcrs>& site,
                 double step_s) {
  Three out;
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = observe(forces, truth, sim_seconds(double(i) * step_s), site);
    out[i].covariance_rad2 = {1e-14, 0, 1e-14};
  }
  return out;
}

// By two-body motion, an exact orbit must come back exactly, by both methods, at any height.
TEST(InitialOrbit, ReturnsTheOrbitOfExactLines) {
  const ForceModel two_body(ForceSettings{.zonals = 0});
  struct Case {
    double radius_m, speed_share, step_s;
  };
  for (const Case& c : {Case{6.9e6, 1.0, 60}, Case{7.5e6, 1.1, 120}, Case{2.66e7, 1.0, 1800},
                        Case{4.2164e7, 1.0, 5000}, Case{9e6, 1.3, 200}}) {
    const double speed = c.speed_share * std::sqrt(earth_gm_m3_per_s2 / c.radius_m);
    const OrbitState truth{
        SimTime{}, {c.radius_m, 0, 0}, {0, speed * std::cos(0.9), speed * std::sin(0.9)}};
    const Three three = lines_from(two_body, truth, {6.2e6, 1e6, 1.1e6}, c.step_s);
    const Vec<Gcrs> place = truth.position_m;
    const auto gauss = gauss_orbit(three);
    ASSERT_TRUE(gauss) << c.radius_m << " " << gauss.reason;
    EXPECT_LT(norm(nearest(*gauss, SimTime{}, place).position_m - place), 20) << c.radius_m;
    const auto gooding = gooding_orbit(three);
    ASSERT_TRUE(gooding) << c.radius_m << " " << gooding.reason;
    EXPECT_LT(norm(nearest(*gooding, SimTime{}, place).position_m - place), 20) << c.radius_m;
  }
}

TEST(InitialOrbit, HardCasesGiveAReason) {
  const ForceModel two_body(ForceSettings{.zonals = 0});
  const OrbitState truth{SimTime{}, {7e6, 0, 0}, {0, std::sqrt(earth_gm_m3_per_s2 / 7e6), 0}};
  // A site in the orbit's plane.
  const auto coplanar = lines_from(two_body, truth, {6.378e6, 0, 0}, 60);
  EXPECT_EQ(gauss_orbit(coplanar).reason,
            "the three lines of sight lie in one plane: ranges are not determined");
  // In their plane three angles stand against four unknowns.
  EXPECT_EQ(gooding_orbit(coplanar).reason, "the three lines of sight do not determine ranges");
  // Zero arc.
  Three same = coplanar;
  same[1].direction = same[2].direction = same[0].direction;
  EXPECT_EQ(gauss_orbit(same).reason, "the arc vanishes: the lines of sight are the same");
  EXPECT_EQ(gooding_orbit(same).reason, "the arc vanishes: the lines of sight are the same");
  Three equal_times = coplanar;
  equal_times[1].time = equal_times[0].time;
  EXPECT_EQ(gauss_orbit(equal_times).reason, "the three times do not increase");
  EXPECT_EQ(gauss_orbit(std::span(coplanar).first(2)).reason, "not three observations");
  Three broken = coplanar;
  broken[0].direction.x = NAN;
  EXPECT_EQ(gooding_orbit(broken).reason, "the direction is not a unit vector");
  // A hyperbola is left out, and taken where it is allowed.
  const OrbitState fast{SimTime{}, {9e6, 0, 0}, {1e3, 11e3, 4e3}};
  const Three open = lines_from(two_body, fast, {6.2e6, 1e6, 1.1e6}, 120);
  OrbitLimits limits;
  limits.open = true;
  const auto taken = gauss_orbit(open, limits);
  ASSERT_TRUE(taken) << taken.reason;
  EXPECT_LT(norm(nearest(*taken, SimTime{}, fast.position_m).position_m - fast.position_m), 50);
  const auto closed = gauss_orbit(open);
  const auto states = closed ? *closed : std::vector<OrbitState>{};
  for (const OrbitState& state : states) EXPECT_TRUE(std::isfinite(apogee_m(state)));
}

// One site, one pass, nothing else known.
TEST(InitialOrbit, OneArcIsFittedWithoutAGuess) {
  const ForceModel forces(ForceSettings{});
  int found = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    TrialSettings settings;
    settings.sites = 1;
    settings.exposures = 31;
    const TrackingTrial trial = tracking_trial(forces, settings, seed);
    const auto fit = one_arc_orbit(forces, trial.observations);
    ASSERT_TRUE(fit) << seed << " " << fit.reason;
    const auto truth = propagate(forces, trial.truth, fit->estimate.state.time);
    ASSERT_TRUE(truth);
    found += nees(fit->estimate, *truth) < 30;  // 6 degrees of freedom: 4e-5 beyond
  }
  EXPECT_EQ(found, 20);
}

TEST(InitialOrbit, TwoSitesNeedTwoTimes) {
  const ForceModel forces(ForceSettings{});
  TrialSettings settings;
  settings.sites = 2;
  settings.exposures = 3;
  const TrackingTrial trial = tracking_trial(forces, settings, 3);
  const std::span<const AngleObservation> all = trial.observations;
  const auto fit = two_site_orbit(forces, all);
  ASSERT_TRUE(fit) << fit.reason;
  const auto truth = propagate(forces, trial.truth, fit->estimate.state.time);
  EXPECT_LT(nees(fit->estimate, *truth), 30);
  EXPECT_EQ(two_site_orbit(forces, all.first(2)).reason,
            "two sites saw it together only once: its velocity is not known");
  EXPECT_EQ(two_site_orbit(forces, all.first(1)).reason,
            "no two sites saw it at about the same time");
}

}  // namespace
}  // namespace dmise
