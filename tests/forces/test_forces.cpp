#include "core/forces/acceleration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/forces/forces.h"
#include "core/tracking/orbit_state.h"

namespace dmise {
namespace {

OrbitState at(const Vec<Gcrs>& position_m, double drag = 0, double srp = 0) {
  return {SimTime{}, position_m, {0, 7.5e3, 0}, drag, srp};
}

Vec<Gcrs> acceleration_m_per_s2(const ForceModel& forces, const OrbitState& state) {
  const Vec<Gcrs>&r = state.position_m, &v = state.velocity_m_per_s;
  const auto a =
      acceleration<double>(forces.settings(), forces.surroundings(state.time), {r.x, r.y, r.z},
                           {v.x, v.y, v.z}, state.drag_m2_per_kg, state.srp_m2_per_kg);
  return {a.x, a.y, a.z};
}

double air_density_kg_per_m3(double height_m) {
  const AirLayer air = air_layer(height_m);
  if (air.density_kg_per_m3 == 0) return 0;
  return air.density_kg_per_m3 * std::exp((air.base_m - height_m) / air.scale_m);
}

// Potential of the zonal harmonics, by Legendre polynomials of the library (Vallado 8-19), with
// the coefficients of EGM2008.
double potential(const Vec<Gcrs>& r, int highest) {
  const double d = norm(r), s = r.z / d;
  double sum = 1;
  const double j[] = {0, 0, 1.0826261738522e-3, -2.5324105185677e-6, -1.6198975999170e-6};
  for (int n = 2; n <= highest; ++n)
    sum -= j[n] * std::pow(6378136.3 / d, n) * std::legendre(unsigned(n), s);
  return earth_gm_m3_per_s2 / d * sum;
}

TEST(Forces, ZonalsAreTheGradientOfTheirPotential) {
  for (const int highest : {0, 2, 3, 4}) {
    const ForceModel forces(ForceSettings{.zonals = highest});
    for (const Vec<Gcrs>& r : {Vec<Gcrs>{7e6, 1e6, 2e6}, {0, 0, 7e6}, {-4e6, 3e6, -5e6}}) {
      const Vec<Gcrs> a = acceleration_m_per_s2(forces, at(r));
      const double h = 50;
      const auto slope = [&](const Vec<Gcrs>& axis) {
        const auto f = [&](double k) { return potential(r + axis * (k * h), highest); };
        return (8 * (f(1) - f(-1)) - (f(2) - f(-2))) / (12 * h);
      };
      const Vec<Gcrs> g{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
      EXPECT_LT(norm(a - g), 3e-9) << highest;
    }
  }
}

// The pole of date: precession since J2000 is 20.04 arcsec of declination a year.
TEST(Forces, PoleIsThatOfDate) {
  const Clock clock(Utc{2459580.5, 0.0});  // 2022-01-01
  const ForceModel forces(clock, SimTime{});
  const Vec<Gcrs> pole = forces.surroundings(SimTime{}).pole;
  EXPECT_NEAR(norm(pole), 1, 1e-12);
  EXPECT_NEAR(std::hypot(pole.x, pole.y) / arcsec, 22 * 20.04, 12);
  // It moves on by less than 0.2 arcsec a day.
  const Vec<Gcrs> later = forces.surroundings(sim_seconds(86400)).pole;
  EXPECT_LT(angle_rad(pole, later), 0.2 * arcsec);
}

// Vallado, table 8-4, at and between its rows.
TEST(Forces, DensityIsThatOfTheTable) {
  EXPECT_NEAR(air_density_kg_per_m3(400e3), 3.725e-12, 1e-18);
  EXPECT_NEAR(air_density_kg_per_m3(1000e3), 3.019e-15, 1e-21);
  // Example of the book: 747.2119 km, 2.1219854e-14 by the scale of its row; rows are joined here.
  EXPECT_NEAR(air_density_kg_per_m3(747.2119e3) / 2.1219854e-14, 1, 0.05);
  double before = 2;
  for (double h = -10e3; h < 6000e3; h += 1e3) {
    const double density = air_density_kg_per_m3(h);
    EXPECT_LE(density, before) << h;
    EXPECT_GE(density, 0);
    before = density;
  }
}

TEST(Forces, DragIsAgainstTheAir) {
  const ForceModel forces(ForceSettings{.zonals = 0});
  const Vec<Gcrs> r{6778137, 0, 0};
  const Vec<Gcrs> a =
      acceleration_m_per_s2(forces, at(r, 0.02)) - acceleration_m_per_s2(forces, at(r));
  const double speed = 7.5e3 - 7.292115146706979e-5 * 6778137;
  EXPECT_NEAR(a.y, -0.5 * 3.725e-12 * 0.02 * speed * speed, 1e-3 * std::fabs(a.y));
  EXPECT_NEAR(a.x, 0, 1e-12);
}

TEST(Forces, SunlightPushesOutsideTheShadow) {
  const Clock clock(Utc{2459580.5, 0.0});
  const ForceModel forces(clock, SimTime{}, {.zonals = 0, .drag = false});
  const Vec<Gcrs> sun = forces.surroundings(SimTime{}).sun_m;
  EXPECT_NEAR(norm(sun) / au_m, 0.9833, 2e-4);  // Astronomical Almanac, near perihelion
  const Vec<Gcrs> towards = unit(sun), across = unit(cross(towards, Vec<Gcrs>{0, 0, 1}));
  const auto push = [&](const Vec<Gcrs>& r) {
    return acceleration_m_per_s2(forces, at(r, 0, 1.0)) - acceleration_m_per_s2(forces, at(r));
  };
  EXPECT_NEAR(norm(push(towards * 4.2e7)), 4.54e-6 / (0.9833 * 0.9833), 2e-8);
  EXPECT_LT(dot(push(towards * 4.2e7), towards), 0);
  EXPECT_EQ(norm(push(towards * -4.2e7)), 0);
  EXPECT_EQ(norm(push(towards * -4.2e7 + across * 6.3e6)), 0);
  EXPECT_GT(norm(push(towards * -4.2e7 + across * 6.4e6)), 0);
}

// The tide of a distant body: 2 gm r / d^3 along it.
TEST(Forces, SunAndMoonPullAsTides) {
  const Clock clock(Utc{2459580.5, 0.0});
  const ForceModel with(clock, SimTime{}, {.zonals = 0, .sun_moon = true});
  const ForceModel without(ForceSettings{.zonals = 0});
  const ForceInputs around = with.surroundings(SimTime{});
  const Vec<Gcrs> r = unit(cross(around.moon_m, around.sun_m)) * 4.2e7;
  const Vec<Gcrs> a = acceleration_m_per_s2(with, at(r)) - acceleration_m_per_s2(without, at(r));
  const double expected = -4.2e7 * (4.9028e12 / std::pow(norm(around.moon_m), 3) +
                                    1.327124e20 / std::pow(norm(around.sun_m), 3));
  EXPECT_NEAR(dot(a, unit(r)), expected, 0.03 * std::fabs(expected));
}

TEST(Forces, RefusesUnknownZonals) {
  EXPECT_THROW(ForceModel(ForceSettings{.zonals = 1}), Error);
  EXPECT_THROW(ForceModel(ForceSettings{.zonals = 5}), Error);
}

}  // namespace
}  // namespace dmise
