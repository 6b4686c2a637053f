#include "core/sky/stars/synthetic_stars.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "core/base/units.h"
#include "core/frames/sky_frames.h"
#include "core/photometry/magnitude.h"
#include "core/sky/stars/sphere_cells.h"
#include "core/sky/stars/star_counts.h"

namespace dmise {
namespace {

using Stars = SyntheticStars::Stars;

Vec<Gcrs> towards(double l_deg, double b_deg) {
  return galactic_from_gcrs().inverse() * from_spherical<Galactic>(l_deg * deg, b_deg * deg);
}

/// Stars of a catalogue that is complete to a magnitude and has a tenth of those of the next.
std::shared_ptr<const StarMap> catalogue_to(double complete_v_mag, const Vec<Gcrs>& axis,
                                            double radius_rad) {
  const Stars stars =
      SyntheticStars(nullptr, 0.0, 21.0).around(axis, radius_rad, complete_v_mag + 1);
  StarCatalogue catalogue;
  for (std::size_t i = 0; i < stars.v_mag.size(); ++i) {
    if (stars.v_mag[i] > complete_v_mag && i % 10 != 0) continue;
    const auto [ra, dec] = to_spherical(stars.direction[i]);
    append_star(catalogue,
                {.id = std::uint32_t(i), .ra_rad = ra, .dec_rad = dec, .v_mag = stars.v_mag[i]});
  }
  return std::make_shared<const StarMap>(star_map_of(std::move(catalogue)));
}

double within(const Stars& stars, const Vec<Gcrs>& axis, double radius_rad, double from_v_mag,
              double to_v_mag) {
  double count = 0;
  for (std::size_t i = 0; i < stars.v_mag.size(); ++i)
    count += angle_rad(stars.direction[i], axis) < radius_rad && stars.v_mag[i] > from_v_mag &&
             stars.v_mag[i] <= to_v_mag;
  return count;
}

double area_deg2(double radius_rad) { return 2 * pi * (1 - std::cos(radius_rad)) / (deg * deg); }

// Reference: Bahcall & Soneira 1980 at 30 and 90 deg and Tycho-2 at 5 deg, as in
// test_star_counts.cpp; within 20 %, and the noise of so many stars.
TEST(SyntheticStars, HaveThePublishedCounts) {
  const SyntheticStars sky(nullptr, 0.0, 21.0);
  const auto expect = [&](double l, double b, double radius, double v_mag, double per_deg2) {
    const Vec<Gcrs> axis = towards(l, b);
    const double brighter_than_9 = StarCounts(galactic_from_gcrs() * axis).brighter_than(9.0);
    const double expected = (per_deg2 - brighter_than_9) * area_deg2(radius * deg);
    const double count =
        within(sky.around(axis, radius * deg, v_mag), axis, radius * deg, 0, v_mag);
    EXPECT_NEAR(count, expected, 0.2 * expected + 4 * std::sqrt(expected)) << b << " " << v_mag;
  };
  expect(90, 30, 1.0, 20, 5190.8);
  expect(90, 30, 3.0, 16, 583.8);
  expect(0, 90, 2.0, 20, 1439.8);
  expect(0, -90, 2.0, 18, 587.8);
  expect(90, 5, 4.0, 11, 42.15);
  expect(200, -5, 4.0, 11, 42.15);
}

// Counts by magnitude, as drawn: Poisson about the model.
TEST(SyntheticStars, HaveTheCountsOfEachMagnitude) {
  for (const double b_deg : {2.0, 40.0}) {
    const Vec<Gcrs> axis = towards(120, b_deg);
    const double radius = 0.6 * deg;
    const Stars stars = SyntheticStars(nullptr, 0.0, 21.0).around(axis, radius, 21.0);
    const StarCounts counts(galactic_from_gcrs() * axis);
    for (double v = 12; v < 21; ++v) {
      const double expected =
          (counts.brighter_than(v + 1) - counts.brighter_than(v)) * area_deg2(radius);
      EXPECT_NEAR(within(stars, axis, radius, v, v + 1), expected,
                  4.5 * std::sqrt(expected) + 0.03 * expected)
          << b_deg << " " << v;
    }
  }
}

// Whoever looks sees the same stars: from a part of the field, or to another limit, or again.
TEST(SyntheticStars, AreTheSameForEveryField) {
  const SyntheticStars sky(nullptr, 0.0, 21.0), other(nullptr, 0.0, 19.0);
  const Vec<Gcrs> axis = towards(75, 4);
  const Stars wide = sky.around(axis, 1.0 * deg, 19.0),
              narrow = other.around(axis, 0.1 * deg, 18.0);
  std::map<std::uint64_t, std::size_t> by_id;
  for (std::size_t i = 0; i < wide.id.size(); ++i) by_id[wide.id[i]] = i;
  EXPECT_EQ(by_id.size(), wide.id.size());
  ASSERT_GT(narrow.id.size(), 100u);
  for (std::size_t i = 0; i < narrow.id.size(); ++i) {
    EXPECT_TRUE(narrow.id[i] & synthetic_star_bit);
    const auto there = by_id.find(narrow.id[i]);
    ASSERT_NE(there, by_id.end());
    EXPECT_EQ(wide.direction[there->second], narrow.direction[i]);
    EXPECT_EQ(wide.v_mag[there->second], narrow.v_mag[i]);
    EXPECT_EQ(wide.bv[there->second], narrow.bv[i]);
  }
  const double expected = within(wide, axis, 0.1 * deg, 0, 18.0);
  EXPECT_EQ(within(narrow, axis, 0.1 * deg, 0, 18.0), expected);
}

// A mean colour of faint stars of half way between turn-off stars and red dwarfs, none impossible.
TEST(SyntheticStars, HaveTwoHeapsOfColours) {
  const Stars stars = SyntheticStars(nullptr, 0.0, 21.0).around(towards(0, 90), 1.5 * deg, 21.0);
  const auto share = [&](double from_bv, double to_bv) {
    double count = 0;
    for (const float bv : stars.bv) count += bv > from_bv && bv <= to_bv;
    return count / double(stars.bv.size());
  };
  EXPECT_EQ(share(-0.31, 2.0), 1.0);
  EXPECT_GT(share(0.4, 0.85), 0.3);
  EXPECT_GT(share(1.1, 1.6), 0.3);
  EXPECT_LT(share(0.95, 1.05), 0.05);
}

// The light that they have is what the smooth starlight has less, but for the noise of few bright
// ones.
TEST(SyntheticStars, HaveTheLightThatTheSmoothStarlightLoses) {
  const Vec<Gcrs> axis = towards(150, 25);
  const double radius = 4 * deg;
  const Stars stars = SyntheticStars(nullptr, 0.0, 18.0).around(axis, radius, 18.0);
  double light = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < stars.v_mag.size(); ++i) {
    if (angle_rad(stars.direction[i], axis) > radius) continue;
    const double one = light_of_magnitude(stars.v_mag[i] - 10.0);
    light += one, variance += one * one;
  }
  const Vec<Galactic> there = galactic_from_gcrs() * axis;
  const double lost = (starlight_of_counts_s10(9.0, there) - starlight_of_counts_s10(18.0, there)) *
                      area_deg2(radius);
  EXPECT_NEAR(light, lost, 3.5 * std::sqrt(variance) + 0.02 * lost);
}

// Where a catalogue ends they go on: with it a cell has as many as without one.
TEST(SyntheticStars, BeginWhereTheCatalogueEnds) {
  const Vec<Gcrs> axis = towards(60, 10);
  const auto catalogue = catalogue_to(12.0, axis, 8 * deg);
  ASSERT_EQ(catalogue->summary.faintest_filled_v_mag, 12.0);
  const SyntheticStars sky(catalogue, 99.0, 15.0);
  EXPECT_EQ(sky.from_v_mag(), 12.0);
  const double radius = 4 * deg;
  const Stars stars = sky.around(axis, radius, 15.0);
  EXPECT_EQ(within(stars, axis, radius, 0, 12.0), 0.0);
  std::vector<std::uint32_t> found;
  query_cone(*catalogue, axis, radius, 99.0, found);
  const StarCounts counts(galactic_from_gcrs() * axis);
  for (double v = 12; v < 14; v += 0.5) {
    double together = within(stars, axis, radius, v, v + 0.5);
    for (const std::uint32_t star : found)
      together += catalogue->stars.v_mag[star] > v && catalogue->stars.v_mag[star] <= v + 0.5;
    const double expected =
        (counts.brighter_than(v + 0.5) - counts.brighter_than(v)) * area_deg2(radius);
    EXPECT_NEAR(together, expected, 0.1 * expected + 4 * std::sqrt(expected)) << v;
  }
}

TEST(SyntheticStars, OfACatalogueOfOneStarGoOnFromIt) {
  StarCatalogue one;
  append_star(one, {.id = 1, .ra_rad = 1.0, .dec_rad = 0.5, .v_mag = 9.7});
  const SyntheticStars sky(std::make_shared<const StarMap>(star_map_of(std::move(one))), 99.0,
                           14.0);
  EXPECT_EQ(sky.from_v_mag(), 10.0);
  const Vec<Gcrs> axis = from_spherical<Gcrs>(1.0, 0.5);
  EXPECT_GT(within(sky.around(axis, 5 * deg, 14.0), axis, 5 * deg, 10.0, 14.0), 1000.0);
}

TEST(SyntheticStars, BrighterThanTheCatalogueAreNone) {
  const auto catalogue = catalogue_to(12.0, towards(60, 10), 3 * deg);
  const SyntheticStars sky(catalogue, 99.0, 11.0);
  EXPECT_GE(sky.from_v_mag(), sky.to_v_mag());
  EXPECT_TRUE(sky.around(towards(60, 10), 2 * deg, 99.0).id.empty());
  EXPECT_EQ(sky.expected_around(towards(60, 10), 2 * deg, 99.0), 0.0);
}

// At the poles of the sky cells are wedges: no gap and no heap.
TEST(SyntheticStars, AtAPoleOfTheSkyAreAsElsewhere) {
  const SyntheticStars sky(nullptr, 0.0, 21.0);
  for (const double pole : {-pi / 2, pi / 2}) {
    const Vec<Gcrs> axis = from_spherical<Gcrs>(0.0, pole);
    const StarCounts counts(galactic_from_gcrs() * axis);
    const Stars stars = sky.around(axis, 1.0 * deg, 19.0);
    for (const double radius : {0.2 * deg, 1.0 * deg}) {
      const double expected =
          (counts.brighter_than(19.0) - counts.brighter_than(9.0)) * area_deg2(radius);
      EXPECT_NEAR(within(stars, axis, radius, 0, 19.0), expected,
                  4 * std::sqrt(expected) + 0.03 * expected);
    }
    double x = 0, y = 0;
    for (const auto& d : stars.direction)
      if (angle_rad(d, axis) < 1.0 * deg) x += d.x / deg, y += d.y / deg;
    EXPECT_LT(std::hypot(x, y), 3 * std::sqrt(double(stars.id.size())));
  }
}

// The centre of the Galaxy to V = 21, half a degree: no more than its cells.
TEST(SyntheticStars, AtTheGalacticCentreAreThoseOfTheFieldAlone) {
  const SyntheticStars sky(nullptr, 0.0, 21.0);
  const Vec<Gcrs> axis = towards(0, 0);
  const double radius = 0.25 * deg;
  const Stars stars = sky.around(axis, radius, 21.0);
  const double in_field = within(stars, axis, radius, 0, 21.0);
  EXPECT_GT(in_field, 10'000.0);
  EXPECT_LT(double(stars.id.size()), 3.5 * in_field);
  EXPECT_NEAR(double(stars.id.size()) / sky.expected_around(axis, radius, 21.0), 1.0, 0.02);
}

std::vector<std::uint32_t> around(const SphereCells& cells, const Vec<Gcrs>& axis,
                                  double radius_rad) {
  std::vector<std::uint32_t> found;
  for (const auto& [first, last] : cells.around(axis, radius_rad))
    for (std::uint32_t cell = first; cell <= last; ++cell) found.push_back(cell);
  return found;
}

TEST(SphereCells, CoverTheSphereOnce) {
  for (const int bands : {2, 90, 360}) {
    const SphereCells cells(bands);
    double area = 0.0;
    for (std::uint32_t k = 0; k < cells.count(); ++k) {
      const auto cell = cells.cell(k);
      area += cell.area_sr();
      EXPECT_EQ(cells.at(cell.middle), k);
    }
    EXPECT_NEAR(area, 4 * pi, 1e-9);
    std::vector<std::uint32_t> all(cells.count());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(around(cells, {0, 0, 1}, pi), all);
  }
}

// Against every cell: those around a cone have a place of each direction in it.
TEST(SphereCells, AroundAConeHaveAllDirectionsInIt) {
  const SphereCells cells(90);
  for (const double ra : {0.001, 3.0, 6.28})
    for (const double dec : {-90.0, -89.0, 0.5, 60.0, 90.0})
      for (const double radius : {0.1, 3.0, 40.0}) {
        const Vec<Gcrs> axis = from_spherical<Gcrs>(ra, dec * deg);
        const std::vector<std::uint32_t> found = around(cells, axis, radius * deg);
        const std::set<std::uint32_t> set(found.begin(), found.end());
        EXPECT_EQ(set.size(), found.size());
        for (int i = 0; i < 400; ++i) {
          const Vec<Gcrs> d = from_spherical<Gcrs>(2 * pi * std::fmod(i * 0.618, 1.0),
                                                   std::asin(2 * (i + 0.5) / 400 - 1));
          // Move it into the cone.
          const Vec<Gcrs> in =
              unit(axis + 0.99 * std::sin(radius * deg) * (d - dot(d, axis) * axis));
          if (angle_rad(in, axis) > radius * deg) continue;
          EXPECT_TRUE(set.contains(cells.at(in)));
        }
      }
}

}  // namespace
}  // namespace dmise
