#include "core/orbit/sgp4/catalogue_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/orbit/elements/epoch.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

using testing::HasSubstr;

const std::string iss =
    "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927\n"
    "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537\n";

TEST(CatalogueReport, ElementsAYearOldAreStale) {
  const CatalogueFile file = parse_catalogue(iss, "t");
  EXPECT_EQ(report_of(file).stale, 0u);
  EXPECT_EQ(report_of(file, parse_iso_epoch("2008-10-19T00:00:00")).stale, 0u);
  EXPECT_EQ(report_of(file, parse_iso_epoch("2009-09-20T12:00:00")).stale, 1u);
  // The last minute of 2008 had 61 seconds.
  EXPECT_NEAR(element_age_days(file.elements[0], *parse_iso_epoch("2009-09-20T12:25:39.104192")),
              365, 1e-9);
}

TEST(CatalogueReport, CountsAndNamesWhatWasRefused) {
  const CatalogueFile file = parse_catalogue("ALONE\nISS\n" + iss, "t");
  const CatalogueReport r = report_of(file);
  EXPECT_EQ(r.records, 2u);
  EXPECT_EQ(r.objects, 1u);
  EXPECT_EQ(r.refused, 1u);
  EXPECT_EQ(r.by_regime[static_cast<int>(OrbitRegime::low)], 1u);
  EXPECT_NEAR(r.lowest_perigee_km, 348, 15);
  EXPECT_THAT(format(r),
              HasSubstr("t:1: neither an element line nor the name of one, got \"ALONE\""));
  EXPECT_THAT(format(r), HasSubstr("newest epoch          2008-09-20T12:25:40.104"));
  EXPECT_THAT(format(r, 0), HasSubstr("and 1 more"));
}

// The counts of the public catalogue of December 2019: its 18,470 objects, its geosynchronous belt.
TEST(CatalogueReport, PublicCatalogueOf2019) {
  const std::string path = test::data_path("tle/catalog_3le_2019-12-19_18470.txt.gz");
  DMISE_NEEDS_FILE(path);
  const CatalogueReport r = report_of(read_catalogue(path));
  EXPECT_EQ(r.objects, 18470u);
  EXPECT_GT(r.by_regime[static_cast<int>(OrbitRegime::low)], 12000u);
  EXPECT_GT(r.by_regime[static_cast<int>(OrbitRegime::geosynchronous)], 800u);
  EXPECT_GT(r.deep_space, 2500u);
}

}  // namespace
}  // namespace dmise
