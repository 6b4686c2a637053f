#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/sky/stars/star_file.h"
#include "core/sky/stars/star_map.h"
#include "core/sky/stars/star_merge.h"
#include "tests/sky/deep_file.h"
#include "tests/support/config_error.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

using test::deep_file;
using Star = test::DeepStar;

TEST(DeepStars, UnitsAreThoseOfTheFieldsAndMagnitudesAreJohnsons) {
  const StarReading read = parse_stars(deep_file({{.ra_1e6h = 6'000'000,
                                                   .dec_1e5deg = -4'500'000,
                                                   .pm_ra = 100,
                                                   .pm_dec = -20,
                                                   .vt = 1000,
                                                   .bt_vt = 100}}),
                                       "deep");
  const StarCatalogue& c = read.catalogue;
  ASSERT_EQ(c.size(), 1u);
  EXPECT_EQ(c.id[0], 1'000'001u);
  EXPECT_NEAR(c.ra_rad[0], 90 * deg, 1e-12);
  EXPECT_NEAR(c.dec_rad[0], -45 * deg, 1e-12);
  EXPECT_NEAR(c.pm_ra_cosdec_rad_per_yr[0], 10 * mas, 1e-18);
  EXPECT_NEAR(c.pm_dec_rad_per_yr[0], -2 * mas, 1e-18);
  EXPECT_EQ(c.parallax_rad[0], 0.0);
  EXPECT_NEAR(c.v_mag[0], 10.0 - 0.090, 1e-6);
  EXPECT_NEAR(c.bv[0], 0.850, 1e-6);
}

TEST(DeepStars, TwoRecordsOfOneContentAreOneStar) {
  const Star one{.vt = 900}, other{.dec_1e5deg = 1, .vt = 900};
  EXPECT_EQ(parse_deep_stars(deep_file({one, other, one, one}), "deep").catalogue.size(), 2u);
}

TEST(DeepStars, StarsWithinFiveArcsecOfAnotherCatalogueAreThatStar) {
  StarCatalogue bright;
  append_star(bright, {.id = 7, .ra_rad = 15 * deg, .dec_rad = 0.0, .v_mag = 8.5, .bv = 0.0});
  const StarCatalogue deep =
      parse_deep_stars(deep_file({{.dec_1e5deg = 138}, {.dec_1e5deg = 140}}), "deep").catalogue;
  const StarCatalogue all = merge_stars(bright, deep);
  EXPECT_EQ(all.id, (std::vector<std::uint32_t>{7, 1'000'002}));
}

std::string problem_of(const std::string& bytes) {
  return test::config_error_of([&] { parse_stars(bytes, "deep"); });
}

TEST(DeepStars, WhatIsWrongIsNamedInALine) {
  const std::string whole = deep_file({{.vt = 900}, {.vt = 1000}});
  for (std::size_t size = 16; size < whole.size(); ++size) {
    const std::string problem = problem_of(whole.substr(0, size));
    EXPECT_TRUE(problem.starts_with("deep: byte ")) << size << " " << problem;
    EXPECT_EQ(problem.find('\n'), problem.npos);
  }
  EXPECT_EQ(problem_of(deep_file({{.vt = 1000}, {.vt = 900}})),
            "deep: byte 358: the records of a trixel must be sorted from bright to faint");
  std::string swapped = whole;
  std::swap(swapped[124], swapped[125]);
  EXPECT_EQ(problem_of(swapped), "deep: byte 124: is not little-endian");
  std::string renamed = whole;
  renamed[129 + 16] = 'X';
  EXPECT_EQ(problem_of(renamed), "deep: byte 145: must describe the field Dec");
  EXPECT_EQ(problem_of(deep_file({{.dec_1e5deg = 9'100'000}})),
            "deep: record 1: declination must be in [-90, 90] deg");
}

/// The whole of Tycho-2 with `kstars`.
class Tycho2 : public testing::Test {
 protected:
  void SetUp() override {
    const std::string deep = test::deep_stars_path();
    if (deep.empty()) DMISE_SKIP() << "needs deepstars.dat, which ./dmise setup --tests fetches";
    const std::string bright = test::catalogue_path("stars.dat.gz");
    static const StarReading read = parse_stars(read_text_file(deep), deep);
    static const StarMap merged = star_map_of(
        merge_stars(parse_stars(read_text_file(bright), bright).catalogue, read.catalogue));
    deep_ = &read;
    map_ = &merged;
  }
  /// The star next to a place.
  std::size_t nearest(double ra_deg, double dec_deg) const {
    const Vec<Gcrs> there = from_spherical<Gcrs>(ra_deg * deg, dec_deg * deg);
    std::vector<std::uint32_t> found;
    query_cone(*map_, there, 10 * arcsec, 99.0, found);
    EXPECT_FALSE(found.empty()) << ra_deg << " " << dec_deg;
    return found.empty() ? 0 : *std::ranges::min_element(found, {}, [&](std::uint32_t i) {
      return angle_rad(there, map_->index.direction[i]);
    });
  }
  const StarReading* deep_ = nullptr;
  const StarMap* map_ = nullptr;
};

// 3,301 of 2,412,252 records repeat another. Tycho-2 has 2,539,913 stars in its main part (Hog et
// al. 2000, A&A 355, L27); the file leaves the brightest to `kstars`.
TEST_F(Tycho2, HoldsItsStarsOnce) {
  EXPECT_EQ(deep_->catalogue.size(), 2'412'252u - 3'301u);
  EXPECT_EQ(deep_->problems.size(), 0u);
  EXPECT_NEAR(double(map_->stars.size()), 2'539'913.0, 0.04 * 2'539'913.0);
}

// Places of J2000.0, motions and V of the Hipparcos catalogue (ESA 1997, SP-1200).
TEST_F(Tycho2, NamedStarsAreWhereTheyArePublished) {
  struct Named {
    const char* name;
    double ra_deg, dec_deg, pm_ra_mas, pm_dec_mas, v_mag, within_mag = 0.2;
  };
  constexpr double of_a_flare_star = 0.3;
  for (const Named& star :
       {Named{"Barnard's star", 269.452083, 4.693391, -798.80, 10277.30, 9.54},
        Named{"Kapteyn's star", 77.919088, -45.018414, 6544.20, -5774.30, 8.86},
        Named{"Groombridge 34 A", 4.595357, 44.022953, 2887.50, 408.90, 8.09},
        Named{"Ross 154", 282.455679, -23.836231, 640.48, -192.00, 10.37, of_a_flare_star},
        Named{"HD 209458", 330.794886, 18.884319, 29.05, -17.80, 7.65},
        Named{"HD 189733", 300.182137, 22.710853, -2.31, -251.28, 7.67}}) {
    const std::size_t i = nearest(star.ra_deg, star.dec_deg);
    const Vec<Gcrs> there = from_spherical<Gcrs>(star.ra_deg * deg, star.dec_deg * deg);
    EXPECT_LT(angle_rad(there, map_->index.direction[i]), 0.5 * arcsec) << star.name;
    const double motion_mas = std::hypot(star.pm_ra_mas, star.pm_dec_mas);
    const double off_mas = std::hypot(map_->stars.pm_ra_cosdec_rad_per_yr[i] / mas - star.pm_ra_mas,
                                      map_->stars.pm_dec_rad_per_yr[i] / mas - star.pm_dec_mas);
    EXPECT_LT(off_mas, 5 + 0.012 * motion_mas) << star.name;
    EXPECT_NEAR(map_->stars.v_mag[i], star.v_mag, star.within_mag) << star.name;
  }
}

// The stars that both catalogues have: places, V and B-V by two ways.
TEST_F(Tycho2, AgreesWithStarsDatWhereBothHaveAStar) {
  const std::string path = test::catalogue_path("stars.dat.gz");
  const StarMap bright = star_map_of(parse_stars(read_text_file(path), path).catalogue);
  std::vector<double> off_arcsec, v, bv;
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < deep_->catalogue.size(); i += 7) {
    found.clear();
    query_cone(bright,
               from_spherical<Gcrs>(deep_->catalogue.ra_rad[i], deep_->catalogue.dec_rad[i]),
               same_star_rad, 99.0, found);
    if (found.size() != 1 || (bright.stars.flags[found[0]] & star_has_no_colour)) continue;
    const Vec<Gcrs> here =
        from_spherical<Gcrs>(deep_->catalogue.ra_rad[i], deep_->catalogue.dec_rad[i]);
    off_arcsec.push_back(angle_rad(here, bright.index.direction[found[0]]) / arcsec);
    v.push_back(deep_->catalogue.v_mag[i] - bright.stars.v_mag[found[0]]);
    bv.push_back(deep_->catalogue.bv[i] - bright.stars.bv[found[0]]);
  }
  ASSERT_GT(v.size(), 10'000u);
  const auto median = [](std::vector<double> x) {
    std::ranges::nth_element(x, x.begin() + std::ptrdiff_t(x.size() / 2));
    return x[x.size() / 2];
  };
  EXPECT_LT(median(off_arcsec), 0.15);
  EXPECT_NEAR(median(v), 0.0, 0.01);
  EXPECT_NEAR(median(bv), 0.0, 0.02);
}

// Stars to a V magnitude over the sky: hnsky.org's counts of Tycho-2 and UCAC4 together.
TEST_F(Tycho2, HasAsManyStarsToAMagnitudeAsOthersCount) {
  for (const auto& [v_mag, stars] : {std::pair{6.0, 5326.0},
                                     {7.0, 16503.0},
                                     {8.0, 48559.0},
                                     {9.0, 139375.0},
                                     {10.0, 382925.0},
                                     {11.0, 1048084.0}})
    EXPECT_NEAR(double(map_->summary.brighter_than(v_mag - 0.01)), stars, 0.16 * stars) << v_mag;
}

}  // namespace
}  // namespace dmise
