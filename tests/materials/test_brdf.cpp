#include "core/materials/brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "tests/materials/brdf_value.h"

namespace dmise {
namespace {

/// Share of light from one direction that goes to all others, by a midpoint sum over the outgoing
/// hemisphere in angle and azimuth.
double reflectance_by_quadrature(const Brdf& brdf, double cos_in, int steps) {
  const double sin_in = std::sqrt(1 - cos_in * cos_in);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double angle = pi / 2 * (i + 0.5) / steps;
    const double cos_out = std::cos(angle), sin_out = std::sin(angle);
    for (int j = 0; j < steps; ++j) {
      const double azimuth = pi * (j + 0.5) / steps;
      const double cos_phase = cos_in * cos_out + sin_in * sin_out * std::cos(azimuth);
      sum += brdf_per_sr(brdf, {cos_in, cos_out, cos_phase}) * cos_out * sin_out;
    }
  }
  return sum * pi * pi / (double(steps) * steps);
}

std::vector<Brdf> many_materials() {
  std::vector<Brdf> all{Lambert{1.0},           Lambert{0.0},
                        Phong{0.34, 0.40, 8.9}, Phong{0.15, 0.25, 0.26},
                        Phong{0.0, 1.0, 0.0},   Phong{0.0, 1.0, 50.0}};
  for (const double b : {0.0, 0.1, 0.3, 0.6, 1.0, 2.0})
    for (const double e : {0.1, 0.4, 1.0})
      for (const double share : {0.0, 0.5, 1.0}) {
        const double most = sandford_robertson_mean(b);
        all.push_back(SandfordRobertson{(1 - share) * most * 0.7, share * most, b, e});
      }
  return all;
}

// Reference: values published with the model of this system.
TEST(SandfordRobertson, HasThePublishedMeansAndLobeNorms) {
  EXPECT_NEAR(sandford_robertson_mean(0.1), 0.963114, 5e-7);
  EXPECT_NEAR(sandford_robertson_mean(0.3), 0.837199, 5e-7);
  EXPECT_NEAR(sandford_robertson_mean(0.6), 0.664564, 5e-7);
  EXPECT_NEAR(sandford_robertson_lobe_norm(1.0, 0.4), 5.38793, 5e-6);
  EXPECT_NEAR(sandford_robertson_lobe_norm(std::cos(60 * deg), 0.4), 3.02934, 5e-6);
  EXPECT_NEAR(sandford_robertson_lobe_norm(std::cos(30 * deg), 0.2), 20.84098, 5e-6);
}

// G is the mean of g: integral of 2 g(t) cos t sin t dt over the hemisphere.
TEST(SandfordRobertson, MeanOfTheFallOffIsItsIntegralAlsoAtTheLimits) {
  for (const double b : {1e-9, 1e-3, 0.05, 0.3, 0.894, 0.8945, 0.95, 0.999999, 1.0, 1.000001, 1.09,
                         1.0955, 1.1, 3.0}) {
    constexpr int steps = 2'000'000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double square = (i + 0.5) / steps;  // cos^2 t, of which 2 cos t sin t dt is the measure
      sum += sandford_robertson_falloff(std::sqrt(square), b) / steps;
    }
    EXPECT_NEAR(sandford_robertson_mean(b), sum, 1e-6) << b;
  }
  EXPECT_DOUBLE_EQ(sandford_robertson_mean(0.0), 1.0);
  EXPECT_DOUBLE_EQ(sandford_robertson_mean(1.0), 0.5);
}

TEST(SandfordRobertson, SeriesAndClosedFormOfTheMeanMeet) {
  const double edge = std::sqrt(0.8);
  EXPECT_NEAR(sandford_robertson_mean(edge * (1 - 1e-12)),
              sandford_robertson_mean(edge * (1 + 1e-12)), 1e-11);
}

TEST(SandfordRobertson, ReflectanceIsTheClosedFormByQuadrature) {
  for (const double b : {0.0, 0.1, 0.3, 0.6, 1.0})
    for (const double e : {0.1, 0.2, 0.4, 1.0})
      for (const double angle_deg : {0.0, 30.0, 60.0, 80.0}) {
        const double cos_in = std::cos(angle_deg * deg);
        const SandfordRobertson m{.emissivity = 0.3, .diffuse = 0.2, .grazing = b, .lobe_width = e};
        const double g = sandford_robertson_falloff(cos_in, b), mean = sandford_robertson_mean(b);
        const double closed = 0.2 * g / mean + (1 - 0.5 * g / mean);
        EXPECT_NEAR(reflectance_by_quadrature(m, cos_in, 700), closed, 1e-4)
            << b << " " << e << " " << angle_deg;
        EXPECT_NEAR(directional_reflectance(m, cos_in), closed, 1e-14);
      }
}

TEST(Phong, ReflectanceIsTheSameByBothQuadratures) {
  for (const double n : {0.0, 0.26, 1.0, 8.9, 60.0})
    for (const double angle_deg : {0.0, 30.0, 60.0, 80.0, 89.0}) {
      const double cos_in = std::cos(angle_deg * deg);
      const Phong m{0.2, 0.5, n};
      EXPECT_NEAR(directional_reflectance(m, cos_in), reflectance_by_quadrature(m, cos_in, 700),
                  1e-4)
          << n << " " << angle_deg;
    }
  EXPECT_NEAR(directional_reflectance(Phong{0.34, 0.40, 8.9}, 1.0), 0.74, 1e-5);
}

TEST(Brdf, NoMaterialReflectsMoreThanFallsIn) {
  for (const Brdf& brdf : many_materials()) {
    EXPECT_NO_THROW(check_brdf(brdf, "m"));
    for (int i = 0; i <= 200; ++i)
      EXPECT_LE(directional_reflectance(brdf, i / 200.0), 1.0 + 1e-9) << brdf.index();
    for (const double cos_in : {1.0, 0.7, 0.3})
      EXPECT_LE(reflectance_by_quadrature(brdf, cos_in, 300), 1.0 + 1e-3) << brdf.index();
  }
}

TEST(Brdf, IsFiniteAndNotNegativeAtEveryGeometry) {
  for (const Brdf& brdf : many_materials())
    for (const double cos_in : {-1.0, -1e-300, 0.0, 1e-300, 1e-9, 0.5, 1.0})
      for (const double cos_out : {-1.0, 0.0, 1e-300, 1e-9, 0.5, 1.0})
        for (const double turn : {-1.0, 0.0, 1.0}) {
          const double cos_phase = std::clamp(
              cos_in * cos_out + turn * std::sqrt((1 - cos_in * cos_in) * (1 - cos_out * cos_out)),
              -1.0, 1.0);
          const double f = brdf_per_sr(brdf, {cos_in, cos_out, cos_phase});
          EXPECT_TRUE(std::isfinite(f) && f >= 0) << cos_in << " " << cos_out << " " << cos_phase;
          if (cos_in <= 0 || cos_out <= 0) {
            EXPECT_EQ(f, 0.0);
          }
        }
}

// Grazing exit: f grows as 1/cos, so that the light that leaves would end at its brightest.
TEST(SandfordRobertson, LightThatLeavesGoesContinuouslyToNothingAtGrazingExit) {
  for (const double e : {0.1, 0.4, 1.0}) {
    const SandfordRobertson m{0.3, 0.2, 0.3, e};
    const auto at = [&](double cos_out) {  // viewer in the plane of incidence, towards the mirror
      const double cos_in = 0.3;
      const double sines = std::sqrt((1 - cos_in * cos_in) * (1 - cos_out * cos_out));
      return reflected_per_sr(m, {cos_in, cos_out, cos_in * cos_out - sines});
    };
    double most = 0;
    for (int i = 1; i <= 1000; ++i) most = std::max(most, at(i / 1000.0));
    for (double angle_deg = 80; angle_deg < 90; angle_deg += 0.01)
      EXPECT_NEAR(at(std::cos((angle_deg + 0.01) * deg)), at(std::cos(angle_deg * deg)),
                  0.02 * most)
          << e << " " << angle_deg;
    EXPECT_LT(at(1e-6), 1e-3 * most);
    // Elsewhere it is the model's own.
    const Reflection usual{0.3, 0.03, 0.2};
    EXPECT_DOUBLE_EQ(reflected_per_sr(m, usual), brdf_per_sr(m, usual) * 0.3 * 0.03);
  }
}

// What the held pole takes of the light: 1 % of the widest lobe.
TEST(SandfordRobertson, HoldingThePoleTakesNoMoreThanAPercent) {
  for (const double e : {0.1, 0.4, 1.0}) {
    const SandfordRobertson m{0.0, 0.0, 0.3, e};  // reflects all
    constexpr int steps = 1000;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double cos_out = (i + 0.5) / steps;
        sum += reflected_per_sr(m, {1.0, cos_out, cos_out}) * 2 * pi / (double(steps) * steps);
      }
    EXPECT_LE(sum, 1.0 + 1e-4) << e;
    EXPECT_GE(sum, 0.989) << e;
  }
}

TEST(Phong, ConservesEnergyForAnyExponent) {
  for (double n = 0.0; n < 1e5; n = n * 1.7 + 0.05)
    for (int i = 0; i <= 50; ++i)
      EXPECT_LE(directional_reflectance(Phong{0.0, 1.0, n}, i / 50.0), 1.0 + 1e-6) << n << " " << i;
}

TEST(CheckBrdf, RefusesWhatWouldReflectMoreThanFallsIn) {
  EXPECT_THROW(check_brdf(Lambert{1.01}, "m"), Error);
  EXPECT_THROW(check_brdf(Lambert{-0.1}, "m"), Error);
  EXPECT_THROW(check_brdf(Lambert{std::nan("")}, "m"), Error);
  EXPECT_THROW(check_brdf(Phong{0.7, 0.4, 1}, "m"), Error);
  EXPECT_THROW(check_brdf(Phong{0.7, 0.1, -1}, "m"), Error);
  EXPECT_THROW(check_brdf(SandfordRobertson{0.5, 0.4, 0.3, 0.4}, "m"), Error);  // G(0.3) = 0.837
  EXPECT_NO_THROW(check_brdf(SandfordRobertson{0.5, 0.337, 0.3, 0.4}, "m"));
  EXPECT_THROW(check_brdf(SandfordRobertson{0.5, 0.1, 0.3, 0.0}, "m"), Error);
  try {
    check_brdf(SandfordRobertson{0.9, 0.1, 0.6, 0.4}, "panel");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "panel: emissivity + diffuse must be <= G(grazing) = 0.664564, got 1");
  }
}

}  // namespace
}  // namespace dmise
