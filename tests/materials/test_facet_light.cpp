#include "core/facets/facet_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/facets/earthshine.h"
#include "core/materials/shapes.h"
#include "core/photometry/diffuse_sphere.h"
#include "tests/materials/brdf_value.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

Material lambert(double reflectance) {
  Material m;
  m.reflectance = {{0.55e-6}, {reflectance}};
  return m;
}

Material shiny() { return sandford_robertson_of("shiny", {{0.55e-6}, {0.5}}, 0.3, 0.3, 0.3); }

Vec<Body> at_angle(double angle_rad) { return {std::sin(angle_rad), 0, std::cos(angle_rad)}; }

// Closed form: physics of the diffuse sphere, A rho F(phi) with F = 2/(3 pi^2) ((pi - phi) cos phi
// + sin phi); A = pi r^2.
TEST(FacetLight, OfALambertSphereOf4500FacetsIsTheClosedForm) {
  const FacetLight ball(sphere(1.5, 5000, lambert(0.2)), Band{});
  for (double phase_deg = 0; phase_deg <= 150; phase_deg += 10) {
    const double closed = pi * 1.5 * 1.5 * 0.2 * diffuse_phase_function(phase_deg * deg);
    const double got = ball.reflected_m2_per_sr(at_angle(0.3), at_angle(0.3 + phase_deg * deg));
    EXPECT_NEAR(got / closed, 1.0, 3e-3) << phase_deg;
  }
}

TEST(FacetLight, OfAPlateIsCosineTimesCosine) {
  const FacetLight sheet(plate(2, 3, lambert(0.4), lambert(0.1)), Band{});
  for (const double in : {0.0, 0.5, 1.2, 1.57})
    for (const double out : {-1.5, -0.3, 0.0, 0.9}) {
      EXPECT_NEAR(sheet.reflected_m2_per_sr(at_angle(in), at_angle(out)),
                  6 * 0.4 / pi * std::cos(in) * std::cos(out), 1e-14);
      EXPECT_NEAR(sheet.reflected_m2_per_sr(at_angle(in + pi), at_angle(out + pi)),
                  6 * 0.1 / pi * std::cos(in) * std::cos(out), 1e-14);
      EXPECT_EQ(sheet.reflected_m2_per_sr(at_angle(in), at_angle(out + pi)), 0.0);
    }
}

TEST(FacetLight, AtPhase180IsNothingAndAtPhase0Finite) {
  for (const Mesh& mesh : {box({1, 2, 3}, shiny()), sphere(1, 320, shiny()),
                           box_wing({}, shiny(), shiny(), lambert(0.5))}) {
    const FacetLight object(mesh, Band{});
    for (const auto& d : even_directions<Body>(50)) {
      EXPECT_EQ(object.reflected_m2_per_sr(d, -d), 0.0);
      const double opposition = object.reflected_m2_per_sr(d, d);
      EXPECT_TRUE(std::isfinite(opposition) && opposition > 0);
    }
  }
}

// Sunlight falls on the cross-section that the object turns to it: no more leaves, whatever the
// material. Summed over all directions of a convex object.
TEST(FacetLight, ReflectsNoMoreThanFallsIn) {
  const Mesh shape = box({1, 2, 3}, Material{});
  for (const Material& m : {lambert(1.0), shiny()}) {
    const FacetLight object(box({1, 2, 3}, m), Band{});
    const auto views = even_directions<Body>(20000);
    for (const auto& sun : even_directions<Body>(7)) {
      double caught = 0, left = 0;
      for (const auto& t : shape.triangles)
        caught += std::max(0.0, dot(double_area_m2(shape, t), sun)) / 2;
      for (const auto& v : views) left += object.reflected_m2_per_sr(sun, v) * 4 * pi / 20000;
      EXPECT_LE(left, caught * 1.003);
      if (m == lambert(1.0)) {
        EXPECT_NEAR(left / caught, 1.0, 3e-3);
      }
    }
  }
}

// A pole of Lambert material over a plate: the plate keeps what the pole's shadow leaves.
TEST(FacetLight, APlateShadesThePlateBehindIt) {
  const Mesh back = plate(4, 4, lambert(0.5), lambert(0.5));
  const Mesh front = moved(plate(1, 1, lambert(0.0), lambert(0.0)), {0, 0, 1});
  const FacetLight both(merged(back, front), Band{});
  const Vec<Body> up{0, 0, 1};
  EXPECT_NEAR(both.reflected_m2_per_sr(up, up), 15 * 0.5 / pi, 1e-12);
  // Sun at 30 deg throws the shadow tan 30 deg aside; the viewer at the zenith misses the square
  // under the front plate: their overlap is 1 x (1 - tan 30 deg).
  const double t = std::tan(30 * deg);
  EXPECT_NEAR(both.reflected_m2_per_sr(at_angle(30 * deg), up),
              (16 - 2 + (1 - t)) * 0.5 / pi * std::cos(30 * deg), 1e-9);
  // Its shadow half off the plate.
  const Vec<Body> low = unit(Vec<Body>{2, 0, 1});
  EXPECT_NEAR(both.reflected_m2_per_sr(low, up), (16 - 1 - 0.5) * 0.5 / pi * low.z, 1e-9);
}

// A ball over a plate: the shadow is the ball's outline, pi r^2 (1 - 5e-4) for its facets.
TEST(FacetLight, ABallOfManyFacetsThrowsARoundShadow) {
  const Mesh ground = plate(4, 4, lambert(1.0), lambert(1.0));
  const Mesh ball = moved(sphere(0.8, 5000, lambert(0.0)), {0.1, 0.2, 1.5});
  const FacetLight both(merged(ground, ball), Band{});
  const Vec<Body> up{0, 0, 1};
  EXPECT_NEAR(both.reflected_m2_per_sr(up, up), (16 - pi * 0.64) / pi, 16 / pi * 1e-3);
}

TEST(FacetLight, AConvexBodyInManyPartsHidesWhatTheSameBodyInOneDoes) {
  const Mesh halves = merged(moved(box({1, 1, 1}, shiny()), {0.5, 0, 0}),
                             moved(box({1, 1, 1}, shiny()), {-0.5, 0, 0}));
  const FacetLight two(halves, Band{}), one(box({2, 1, 1}, shiny()), Band{});
  EXPECT_FALSE(two.convex());
  const auto d = even_directions<Body>(30);
  for (std::size_t i = 0; i + 7 < d.size(); ++i) {
    const double whole = one.reflected_m2_per_sr(d[i], d[i + 7]);
    EXPECT_NEAR(two.reflected_m2_per_sr(d[i], d[i + 7]), whole, 1e-6 * whole + 1e-12);
  }
}

TEST(FacetLight, IsTheBrdfOfEachModelFacetByFacet) {
  for (const Material& m : {shiny(), Material{.model = Material::Model::phong,
                                     .reflectance = {},
                                     .diffuse = {{1e-6}, {0.34}},
                                     .specular = {{1e-6}, {0.4}},
                                     .exponent = 8.9}}) {
    const FacetLight object(box({1, 2, 3}, m), Band{});
    const Brdf brdf = brdf_in_band(m, Band{});
    const auto d = even_directions<Body>(40);
    for (std::size_t i = 0; i + 3 < d.size(); ++i) {
      double sum = 0;
      for (const auto& t : object.mesh().triangles) {
        const Vec<Body> twice = double_area_m2(object.mesh(), t), n = unit(twice);
        sum += norm(twice) / 2 *
               reflected_per_sr(brdf, {dot(n, d[i]), dot(n, d[i + 3]), dot(d[i], d[i + 3])});
      }
      EXPECT_NEAR(object.reflected_m2_per_sr(d[i], d[i + 3]), sum, 1e-12 * sum + 1e-300);
    }
  }
}

TEST(FacetLight, IsTheSameToTheBitOnEveryInstructionSet) {
  const FacetLight object(sphere(1, 1000, shiny()), Band{});
  const auto d = even_directions<Body>(20);
  for (std::size_t i = 0; i + 1 < d.size(); ++i) {
    const double reference = object.reflected_m2_per_sr(d[i], d[i + 1], SimdLevel::sse2);
    for (const SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      EXPECT_EQ(object.reflected_m2_per_sr(d[i], d[i + 1], level), reference) << name(level);
    }
  }
}

TEST(FacetLight, AFacetEdgeOnAddsNothing) {
  const FacetLight sheet(plate(1, 1, shiny(), shiny()), Band{});
  const double edge = sheet.reflected_m2_per_sr({1, 0, 0}, {0, 0, 1});
  EXPECT_EQ(edge, 0.0);
  EXPECT_EQ(sheet.reflected_m2_per_sr({0, 0, 1}, {1, 0, 0}), 0.0);
}

// Over the last degree before a plate turns edge-on its light falls to nothing without a jump.
TEST(FacetLight, FadesAsItTurnsEdgeOn) {
  const FacetLight sheet(plate(1, 1, shiny(), shiny()), Band{});
  const auto seen = [&](double angle_deg) {
    return sheet.reflected_m2_per_sr(at_angle(-60 * deg), at_angle(angle_deg * deg));
  };
  const double most = seen(80);
  EXPECT_LT(seen(89.9999), 1e-3 * most);
  EXPECT_GT(seen(88.5), 0.1 * most);
  EXPECT_EQ(seen(90.0001), 0.0);
}

// Warm panels: emitted light is the projected area times the radiance.
TEST(FacetLight, EmitsByTheAreaThatItShows) {
  Material warm = lambert(0.1);
  warm.temperature_k = 300;
  warm.thermal_emissivity = 0.8;
  const Band thermal{.name = "N", .centre_m = 10e-6, .width_m = 4e-6};
  const FacetLight sheet(plate(2, 3, warm, lambert(0.1)), thermal);
  const double at_normal = sheet.emitted_photons_per_s_sr({0, 0, 1});
  EXPECT_GT(at_normal, 0.0);
  EXPECT_NEAR(sheet.emitted_photons_per_s_sr(at_angle(1.0)) / at_normal, std::cos(1.0), 1e-12);
  EXPECT_EQ(sheet.emitted_photons_per_s_sr({0, 0, -1}), 0.0);
}

// Far away the Earth is a point: a Lambert sphere of geometric albedo 2/3 of its reflectance.
TEST(Earthshine, FarAwayIsTheClosedFormOfADiffuseSphere) {
  const double d = 1000 * 6371e3;
  for (const double phase_deg : {0.0, 45.0, 90.0, 135.0}) {
    double sum = 0;
    for (const auto& s :
         earthshine_sources({.albedo = 0.3, .rings = 24}, {0, 0, -d}, at_angle(phase_deg * deg)))
      sum += s.share;
    EXPECT_NEAR(sum / (pi * 1e-6 * 0.3 * diffuse_phase_function(phase_deg * deg)), 1.0, 0.02)
        << phase_deg;
  }
}

// Close above the sunlit ground: half of the sky is a diffuse surface.
TEST(Earthshine, CloseToTheGroundIsThatOfAnEndlessPlain) {
  const Vec<Body> down{0, 0, -1};
  double on_plate = 0;
  for (const auto& s : earthshine_sources({.albedo = 0.3, .rings = 60}, down * 6381e3, {0, 0, 1}))
    on_plate += s.share * std::max(0.0, dot(s.to_source, down));
  EXPECT_NEAR(on_plate, 0.3, 0.01);
}

TEST(Earthshine, OverTheNightSideIsNone) {
  EXPECT_TRUE(earthshine_sources({}, {0, 0, -7000e3}, {0, 0, -1}).empty());
}

}  // namespace
}  // namespace dmise
