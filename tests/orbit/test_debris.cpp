#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/base/units.h"
#include "core/frames/vec.h"
#include "core/orbit/debris/debris_population.h"
#include "core/orbit/sgp4/sgp4_terms.h"
#include "core/orbit/two_body.h"

namespace dmise {
namespace {

constexpr double year_s = 365.25 * 86400;
constexpr double ground_m = 6378137.0;

InclinationCounts planes_in_any_direction() {
  InclinationCounts counts;
  for (std::size_t degree = 0; degree < 180; ++degree)
    counts[degree] = int(1e5 * std::sin((double(degree) + 0.5) * deg));
  return counts;
}

/// 5 to 10 cm at 700 to 1100 km, mostly in steep orbits.
DebrisPopulation population() {
  DebrisPopulation p{.name = "p",
                     .first_number = 990000001,
                     .year = 2000,
                     .solar_flux_sfu = 180,
                     .min_size_m = 0.05,
                     .max_size_m = 0.1,
                     .min_height_m = 700e3,
                     .max_height_m = 1100e3,
                     .epoch = {2451544.5, 0.0}};
  p.inclinations[65] = 3;
  p.inclinations[74] = 2;
  p.inclinations[82] = 4;
  p.inclinations[98] = 6;
  p.inclinations[28] = 1;
  return p;
}

double axis_m(const MeanElements& e) {
  return std::pow(sgp4::xke / e.mean_motion_rad_per_min, 2.0 / 3.0) * sgp4::earth_radius_m;
}

/// A circular orbit.
struct Circle {
  Circle(double radius_m, double inclination_rad, double raan_rad)
      : radius_m(radius_m),
        node{std::cos(raan_rad), std::sin(raan_rad), 0.0},
        ahead{-std::sin(raan_rad) * std::cos(inclination_rad),
              std::cos(raan_rad) * std::cos(inclination_rad), std::sin(inclination_rad)} {}

  MotionState<Gcrs> at(double angle_rad) const {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double speed = std::sqrt(earth_gm_m3_per_s2 / radius_m);
    return {radius_m * (c * node + s * ahead), speed * (c * ahead - s * node)};
  }

  double radius_m;
  Vec<Gcrs> node, ahead;
};

/// Kolmogorov and Smirnov's distance times the root of the number: 1.628 at p = 0.01.
double distance(std::vector<double> drawn, const std::function<double(double)>& cumulative) {
  std::ranges::sort(drawn);
  const double n = double(drawn.size());
  double most = 0.0;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const double at = cumulative(drawn[k]);
    most = std::max({most, std::abs(at - double(k) / n), std::abs(at - double(k + 1) / n)});
  }
  return most * std::sqrt(n);
}

/// Integral by the trapezoidal rule.
double integral(const std::function<double(double)>& f, double from, double to) {
  constexpr int steps = 400;
  double sum = 0.5 * (f(from) + f(to));
  for (int k = 1; k < steps; ++k) sum += f(from + (to - from) * k / steps);
  return sum * (to - from) / steps;
}

// Impacts per square metre and year, the formulas of SSP 30425 evaluated by Python.
TEST(Debris, FluxIsThePublishedOne) {
  for (const auto& [cm, in_1988, in_2013] : {std::tuple{0.1, 3.86047210e-3, 6.58469647e-3},
                                             {1.0, 1.66586148e-5, 2.88930674e-5},
                                             {10.0, 1.86395550e-6, 4.13554485e-6},
                                             {100.0, 3.18331077e-7, 7.16176522e-7}}) {
    EXPECT_NEAR(debris_flux_by_size(cm / 100, 1988) * year_s / in_1988, 1.0, 1e-6) << cm;
    EXPECT_NEAR(debris_flux_by_size(cm / 100, 2013) * year_s / in_2013, 1.0, 1e-6) << cm;
  }
  // 10^(500/200 - 140/140 - 1.5) = 1, 10^(700/200 - 1 - 1.5) = 10.
  EXPECT_NEAR(debris_flux_by_height(500e3, 140), 0.5, 1e-12);
  EXPECT_NEAR(debris_flux_by_height(700e3, 140), 10.0 / 11.0, 1e-12);
}

TEST(Debris, LargerObjectsAreFewer) {
  for (const double year : {1988.0, 2011.0, 2030.0, 2100.0})
    for (double d_m = 1e-3; d_m < 10; d_m *= 1.01)
      ASSERT_GT(debris_flux_by_size(d_m, year), debris_flux_by_size(1.01 * d_m, year));
}

// Where planes are isotropic, the density is that of the shell and velocities are isotropic in the
// horizontal plane: the mean of 2 sin(angle / 2) is 4 / pi. Polar orbits cross the equator at 2 /
// pi of their mean density, at the root of two times the speed.
TEST(Debris, EncountersAreThoseOfTheirGeometry) {
  for (const double inclination_deg : {10.0, 45.0, 90.0, 120.0})
    EXPECT_NEAR(encounter_factor(planes_in_any_direction(), inclination_deg * deg), 4 / pi, 4e-3);
  InclinationCounts polar{};
  polar[89] = polar[90] = 1;
  EXPECT_NEAR(encounter_factor(polar, 0.0), 2 / pi * std::sqrt(2.0), 1e-3);
}

// NASA's estimates of 2013, as Hall 2014 quotes them (Space Traffic Management Conference, "The
// history of space debris"): 500,000 objects over 1 cm, more than 100 million smaller ones;
// ESA's of that year: 670,000 over 1 cm, 170 million over 1 mm.
TEST(Debris, NumbersAreThoseOfEstimates) {
  DebrisPopulation p{.year = 2013, .min_size_m = 0.01, .max_size_m = 10};
  p.inclinations = population().inclinations;
  EXPECT_GT(p.mean_count(), 450'000);
  EXPECT_LT(p.mean_count(), 670'000);
  p.min_size_m = 1e-3;
  EXPECT_GT(p.mean_count(), 100e6);
  EXPECT_LT(p.mean_count(), 170e6);
}

// Counts objects in a ball about a spacecraft, at random instants: a quarter of their density times
// relative speed is the flux.
TEST(Debris, TheFluxOnASpacecraftIsThePublishedOne) {
  DebrisPopulation p = population();
  p.min_size_m = 0.02;
  const auto drawn = draw_debris(p, 1);
  constexpr double ball_m = 200e3, at_m = ground_m + 900e3;
  constexpr int looks = 800;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> turn(0.0, 2 * pi);
  std::vector<Circle> circles;
  for (const MeanElements& e : drawn.elements)
    circles.emplace_back(axis_m(e), e.inclination_rad, e.raan_rad);
  double speeds = 0.0;
  for (int look = 0; look < looks; ++look) {
    const auto spacecraft = Circle(at_m, 45 * deg, turn(random)).at(turn(random));
    for (const Circle& circle : circles) {
      const auto object = circle.at(turn(random));
      if (norm(object.position_m - spacecraft.position_m) < ball_m)
        speeds += norm(object.velocity_m_per_s - spacecraft.velocity_m_per_s);
    }
  }
  const double flux = 0.25 * speeds / looks / (4 * pi / 3 * std::pow(ball_m, 3));
  const double published =
      0.990 * debris_flux_by_height(900e3, p.solar_flux_sfu) *
      (debris_flux_by_size(p.min_size_m, p.year) - debris_flux_by_size(p.max_size_m, p.year));
  EXPECT_NEAR(flux / published, 1.0, 0.08);  // some 1700 objects
}

TEST(Debris, SizesHeightsAndInclinationsAreAsStated) {
  DebrisPopulation p = population();
  p.min_height_m = 300e3;
  p.min_size_m = 0.02;
  p.max_size_m = 0.5;
  p.scale = 0.2;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto drawn = draw_debris(p, seed);
    ASSERT_GT(drawn.elements.size(), 3000u);
    const auto flux = [&](double d_m) { return debris_flux_by_size(d_m, p.year); };
    EXPECT_LT(distance(drawn.diameters_m,
                       [&](double d_m) {
                         return (flux(p.min_size_m) - flux(d_m)) /
                                (flux(p.min_size_m) - flux(p.max_size_m));
                       }),
              1.628);
    std::vector<double> heights_m, inclinations_deg, nodes, anomalies;
    for (const MeanElements& e : drawn.elements) {
      heights_m.push_back(axis_m(e) - ground_m);
      inclinations_deg.push_back(e.inclination_rad / deg);
      nodes.push_back(e.raan_rad / (2 * pi));
      anomalies.push_back(e.mean_anomaly_rad / (2 * pi));
      ASSERT_EQ(e.eccentricity, 0.0);
    }
    // Objects of a shell are flux over speed, times its area.
    const auto density = [&](double height_m) {
      const double phi = std::pow(10.0, height_m / 2e5 - p.solar_flux_sfu / 140 - 1.5);
      return phi / (1 + phi) * std::pow(ground_m + height_m, 2.5);
    };
    const double all = integral(density, p.min_height_m, p.max_height_m);
    EXPECT_LT(distance(heights_m,
                       [&](double h_m) { return integral(density, p.min_height_m, h_m) / all; }),
              1.628);
    EXPECT_LT(distance(inclinations_deg,
                       [&](double i_deg) {
                         double below = 0.0;
                         for (std::size_t degree = 0; degree < 180; ++degree)
                           below += p.inclinations[degree] *
                                    std::clamp(i_deg - double(degree), 0.0, 1.0);
                         return below / 16;
                       }),
              1.628);
    for (const auto& angles : {nodes, anomalies})
      EXPECT_LT(distance(angles, [](double part) { return part; }), 1.628);
  }
}

TEST(Debris, NumbersArePoissons) {
  DebrisPopulation p = population();
  p.scale = 20.0 / p.mean_count();
  double sum = 0.0, squares = 0.0;
  constexpr int seeds = 400;
  for (int seed = 0; seed < seeds; ++seed) {
    const double n = double(draw_debris(p, std::uint64_t(seed)).elements.size());
    sum += n / seeds;
    squares += (n - 20) * (n - 20) / seeds;
  }
  EXPECT_NEAR(sum, 20.0, 4 * std::sqrt(20.0 / seeds));
  EXPECT_NEAR(squares, 20.0, 4 * std::sqrt((20 + 2 * 20.0 * 20) / seeds));
}

TEST(Debris, SmallerObjectsComeBesideTheLarger) {
  DebrisPopulation p = population();
  p.scale = 0.01;
  const auto large = draw_debris(p, 7);
  EXPECT_EQ(large.elements, draw_debris(p, 7).elements);
  EXPECT_NE(large.elements, draw_debris(p, 8).elements);
  p.min_size_m = 0.02;
  const auto more = draw_debris(p, 7);
  ASSERT_GT(more.diameters_m.size(), 2 * large.diameters_m.size());
  for (std::size_t k = 0; k < large.diameters_m.size(); ++k) {
    ASSERT_EQ(more.diameters_m[k], large.diameters_m[k]);
    ASSERT_EQ(more.elements[k].inclination_rad, large.elements[k].inclination_rad);
  }
  EXPECT_EQ(more.elements[1].catalogue_number, 990000002u);
  p.seed = 7;
  EXPECT_EQ(draw_debris(p, 8).elements, more.elements);
}

}  // namespace
}  // namespace dmise
