#include "core/orbit/sgp4/synthetic_catalogue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/element_text.h"
#include "core/orbit/sgp4/catalogue_report.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

TEST(SyntheticCatalogue, ObjectIsAFunctionOfSeedAndIndexAlone) {
  const auto few = synthetic_catalogue({.objects = 100, .seed = 7});
  const auto many = synthetic_catalogue({.objects = 1000, .seed = 7});
  const auto others = synthetic_catalogue({.objects = 100, .seed = 8});
  std::size_t same = 0;
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_TRUE(few[i] == many[i]);
    same += few[i].raan_rad == others[i].raan_rad;
  }
  EXPECT_LE(same, 1u);
  const auto middle = synthetic_catalogue({.objects = 50, .first = 700, .seed = 7});
  for (std::size_t i = 0; i < middle.size(); ++i) EXPECT_TRUE(middle[i] == many[700 + i]);
}

// Shares are those of the header, to 4 sigmas of 100,000 draws.
TEST(SyntheticCatalogue, SharesOfRegimesAreAsDocumented) {
  const std::size_t n = 100000;
  CatalogueFile file;
  file.elements = synthetic_catalogue({.objects = n, .seed = 1});
  const CatalogueReport r = report_of(file);
  const auto expect_share = [&](std::size_t count, double share) {
    EXPECT_NEAR(double(count) / n, share, 4 * std::sqrt(share * (1 - share) / n));
  };
  expect_share(r.by_regime[static_cast<int>(OrbitRegime::geosynchronous)], 0.055);
  expect_share(r.by_regime[static_cast<int>(OrbitRegime::highly_elliptic)], 0.05);
  expect_share(r.deep_space, 0.055 + 0.025 + 0.05);
  EXPECT_EQ(r.stale, 0u);
  EXPECT_GT(r.lowest_perigee_km, 190);
}

TEST(SyntheticCatalogue, ResonantOrbitsAreWhereTheyShouldBe) {
  for (const MeanElements& e : synthetic_catalogue({.objects = 20000, .seed = 3})) {
    const double rev_per_day = e.mean_motion_rad_per_min * 1440 / (2 * pi);
    if (e.name == "MOLNIYA") {
      EXPECT_NEAR(rev_per_day, 2.006, 0.012);
      EXPECT_NEAR(e.inclination_rad / deg, 63.4, 6);
      EXPECT_NEAR(e.argument_of_perigee_rad / deg, 270, 50);
    }
    if (e.name == "GEO") {
      EXPECT_NEAR(rev_per_day, 1.0027, 0.001);
    }
    // The node of a Sun-synchronous orbit turns by 0.9856 deg a day: 97.2 to 98.8 deg at 450 to 850
    // km.
    if (e.name == "SSO") {
      EXPECT_NEAR(e.inclination_rad / deg, 98.0, 1.4);
    }
  }
}

TEST(SyntheticCatalogue, NumbersAreUniqueAndAMillionIsTheLimit) {
  const auto catalogue = synthetic_catalogue({.objects = 5000});
  std::set<std::uint32_t> numbers;
  for (const auto& e : catalogue) numbers.insert(e.catalogue_number);
  EXPECT_EQ(numbers.size(), 5000u);
  EXPECT_THROW(synthetic_catalogue({.objects = 1000001}), Error);
  EXPECT_THROW(synthetic_catalogue({.objects = 2, .first = 999999}), Error);
}

TEST(ElementText, WrittenTleReadsBackToTheSameBits) {
  const auto catalogue = synthetic_catalogue({.objects = 5000, .seed = 2});
  const CatalogueFile file = parse_catalogue(format_3le(catalogue), "t");
  ASSERT_TRUE(file.refused.empty()) << file.refused[0].reason;
  ASSERT_EQ(file.elements.size(), catalogue.size());
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    EXPECT_TRUE(file.elements[i] == catalogue[i]) << i << "\n" << format_tle(catalogue[i]);
  }
}

TEST(ElementText, WrittenOmmReadsBackToTheLastDigit) {
  auto catalogue = synthetic_catalogue({.objects = 5000, .seed = 2});
  catalogue[0].catalogue_number = 999999999;
  catalogue[1].name = "A \"B\", C";
  catalogue[1].designator = "98067A";
  CatalogueFile file = parse_catalogue(format_omm_csv(catalogue), "t");
  ASSERT_EQ(file.elements.size(), catalogue.size());
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    MeanElements& e = file.elements[i];
    EXPECT_NEAR(e.epoch_jd2, catalogue[i].epoch_jd2, 2e-16);
    EXPECT_NEAR(e.bstar_per_earth_radius, catalogue[i].bstar_per_earth_radius, 1e-18);
    e.epoch_jd2 = catalogue[i].epoch_jd2;
    e.bstar_per_earth_radius = catalogue[i].bstar_per_earth_radius;
    EXPECT_TRUE(e == catalogue[i]) << i;
  }
}

// 979 sets of a published file, written and read again.
// blanks).
TEST(ElementText, RealSetsSurviveBeingWrittenAndRead) {
  const std::string path = test::catalogue_path("demo.tle");
  const auto original = read_catalogue(path).elements;
  const auto again = parse_catalogue(format_3le(original), "t");
  ASSERT_EQ(again.elements.size(), original.size());
  for (std::size_t i = 0; i < original.size(); ++i)
    EXPECT_TRUE(again.elements[i] == original[i]) << format_tle(original[i]);
}

TEST(ElementText, NumbersBeyondAlpha5AndYearsBeyond2056DoNotFitATle) {
  MeanElements e = synthetic_catalogue({.objects = 1})[0];
  e.catalogue_number = 339999;
  EXPECT_EQ(format_tle(e).substr(2, 5), "Z9999");
  e.catalogue_number = 340000;
  EXPECT_THROW(format_tle(e), Error);
  e.catalogue_number = 1;
  e.epoch_jd1 = 2472639.5;  // 2057-10-03
  EXPECT_THROW(format_tle(e), Error);
}

}  // namespace
}  // namespace dmise
