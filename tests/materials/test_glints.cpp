#include "core/facets/glints.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr Glints oneweb{.narrowest_rad = 0.15 * deg,
                        .widest_rad = 4.8 * deg,
                        .parts_in_view = 0.12,
                        .share_of_narrowest = 0.0085,
                        .share_of_widest = 0.12};

Vec<Body> direction(double from_pole_rad, double longitude_rad) {
  return {std::sin(from_pole_rad) * std::cos(longitude_rad),
          std::sin(from_pole_rad) * std::sin(longitude_rad), std::cos(from_pole_rad)};
}

RngKey object(std::uint32_t number, std::uint64_t seed = 1) { return glint_key(seed, "X", number); }

/// Light of parts that are seen at a bisector, which is where Sun and viewer are in one direction.
double light(const GlintField& field, const RngKey& key, const Vec<Body>& at) {
  return field.over_smooth(key, at, at);
}

TEST(GlintField, HaveOctavesOfLobes) {
  const auto lobes = lobes_of(oneweb);
  ASSERT_EQ(lobes.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(lobes[i].half_width_rad / deg, 0.15 * std::exp2(double(i)), 1e-12);
  EXPECT_NEAR(lobes[5].share, 0.12, 1e-12);
  EXPECT_NEAR(lobes[1].share / lobes[0].share, lobes[4].share / lobes[3].share, 1e-12);
}

// Campbell's theorem: parts at random have the smooth light on the mean, and a variance of
// 16/7 share^2 / parts in view for lobes of (1 - v)^3. At the poles of the cells as elsewhere.
TEST(GlintField, LeaveTheMeanOverObjects) {
  double wanted = 0.0;
  for (const auto& lobe : lobes_of(oneweb)) wanted += 16.0 / 7.0 * lobe.share * lobe.share / 0.12;
  const GlintField field(oneweb);
  constexpr int objects = 40000;
  for (const double from_pole_deg : {0.0, 0.1, 3.0, 90.0, 137.0, 180.0}) {
    const Vec<Body> at = direction(from_pole_deg * deg, 1.0);
    double sum = 0.0, square = 0.0;
    for (std::uint32_t i = 0; i < objects; ++i) {
      const double x = light(field, object(i), at) - 1.0;
      sum += x / objects;
      square += x * x / objects;
    }
    EXPECT_NEAR(sum, 0.0, 4.0 * std::sqrt(wanted / objects)) << from_pole_deg;
    EXPECT_NEAR(square / wanted, 1.0, 0.1) << from_pole_deg;
  }
}

// What one object reflects in all directions is what its smooth surfaces do, but for the number of
// its parts: 22 with the widest lobes have an eighth of the light.
TEST(GlintField, ReflectNoMoreThanTheSurfaces) {
  const GlintField field(oneweb);
  for (std::uint32_t number = 1; number <= 5; ++number) {
    double sum = 0.0;
    constexpr int points = 40000;  // a spiral: even over the sphere
    for (int i = 0; i < points; ++i)
      sum += light(field, object(number),
                   direction(std::acos(1.0 - (2.0 * i + 1.0) / points), 2.399963229728653 * i)) /
             points;
    EXPECT_NEAR(sum, 1.0, 4.0 * 0.12 / std::sqrt(22.0)) << number;
  }
}

// Edges along x glint where the bisector is across x: by their share over 0.0351, the mean over the
// sphere of (1 - v / v0)^3 for a half width of 2 deg (scipy.integrate.quad of its cosine), and
// nowhere else.
TEST(GlintField, OfEdgesAreAcrossTheirAxisAndLeaveTheMean) {
  Glints with = oneweb;
  with.edges = GlintingEdges{.axis = {1, 0, 0}, .half_width_rad = 2.0 * deg, .share = 0.02};
  const GlintField field(with), without(oneweb);
  const auto of_edges = [&](const Vec<Body>& at) {
    return light(field, object(3), at) - light(without, object(3), at) + 0.02;
  };
  constexpr double mean_of_lobe = 0.035122;
  for (const double around : {0.1, 1.3, 4.0}) {
    const auto tilted = [&](double rad) {
      return Vec<Body>{std::sin(rad), std::cos(rad) * std::cos(around),
                       std::cos(rad) * std::sin(around)};
    };
    EXPECT_NEAR(of_edges(tilted(0.0)), 0.02 / mean_of_lobe, 1e-4);
    EXPECT_NEAR(of_edges(tilted(2.0 * deg)), 0.01 / mean_of_lobe, 1e-4);
    EXPECT_NEAR(of_edges(tilted(-2.0 * deg)), 0.01 / mean_of_lobe, 1e-4);
    EXPECT_NEAR(of_edges(tilted(6.0 * deg)), 0.0, 1e-12);
  }
}

TEST(GlintField, AreOfTheGeometryTheObjectAndTheSeed) {
  const GlintField field(oneweb), another(oneweb);
  const Vec<Body> sun = direction(0.5, 0.2), viewer = direction(0.9, -0.3);
  const double here = field.over_smooth(object(7), sun, viewer);
  EXPECT_EQ(another.over_smooth(object(7), sun, viewer), here);
  EXPECT_EQ(field.over_smooth(object(7), viewer, sun), here);  // reciprocal
  EXPECT_NE(field.over_smooth(object(8), sun, viewer), here);
  EXPECT_NE(field.over_smooth(object(7, 2), sun, viewer), here);
  EXPECT_NE(field.over_smooth(glint_key(1, "Y", 7), sun, viewer), here);
}

// No step from cell to cell: lobes of 0.15 deg change by 1.7 of their peak over the reach of
// 0.33 deg at most.
TEST(GlintField, AreSmoothAcrossCellsAndPoles) {
  const Glints narrow{.narrowest_rad = 0.15 * deg,
                      .widest_rad = 0.15 * deg,
                      .parts_in_view = 3.0,
                      .share_of_narrowest = 0.5,
                      .share_of_widest = 0.5};
  const GlintField field(narrow);
  constexpr double step_deg = 0.001, peak = 4.0 * 0.5 / 3.0;
  double last = light(field, object(1), direction(-2.0 * deg, 0.3)), largest = 0.0;
  for (double x = -2.0 + step_deg; x < 2.0; x += step_deg) {  // over a pole
    const double next = light(field, object(1), direction(x * deg, 0.3));
    largest = std::max(largest, std::abs(next - last));
    last = next;
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(largest, 6.0 * peak * 1.72 * step_deg / 0.33);
  last = light(field, object(1), direction(1.1, pi - 2.0 * deg));
  for (double x = -2.0 + step_deg; x < 2.0; x += step_deg) {  // over the seam of longitudes
    const double next = light(field, object(1), direction(1.1, pi + x * deg));
    EXPECT_LT(std::abs(next - last), 6.0 * peak * 1.72 * step_deg / 0.33);
    last = next;
  }
}

TEST(GlintField, NeedNoBisectorWhereThereIsNone) {
  const GlintField field(oneweb);
  const Vec<Body> sun = direction(0.5, 0.2);
  EXPECT_EQ(field.over_smooth(object(7), sun, -sun), 1.0);
}

}  // namespace
}  // namespace dmise
