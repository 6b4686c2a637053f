#include "core/orbit/elements/facts_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

std::string complaint(const std::string& text, const FactsColumns& columns) {
  try {
    import_facts(text, "sizes.csv", columns);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(FactsImport, ColumnsKindsAndUnitsAreTheUsers) {
  const std::string text =
      "\xEF\xBB\xBFNORAD_CAT_ID, OBJECT ,RCS,R,D\n5,\"A, B\",-10,50,1200\n6,C,,,0\n7,D,3,1.5,\n";
  const auto rcs =
      import_facts(text, "s", {.size = "RCS", .kind = SizeKind::rcs, .unit = SizeUnit::dbsm});
  EXPECT_EQ(rcs.rows, 3u);
  EXPECT_EQ(rcs.unknown, 1u);
  EXPECT_NEAR(*rcs.file.facts.at(5).rcs_m2, 0.1, 1e-15);
  EXPECT_NEAR(*rcs.file.facts.at(7).rcs_m2, 1.9952623, 1e-7);
  const auto radius =
      import_facts(text, "s", {.size = "R", .kind = SizeKind::radius, .unit = SizeUnit::cm});
  EXPECT_NEAR(sphere_of(radius.file.facts.at(5)).sphere.radius_m, 0.5, 1e-15);
  const auto diameter =
      import_facts(text, "s", {.size = "D", .kind = SizeKind::diameter, .unit = SizeUnit::mm});
  EXPECT_NEAR(sphere_of(diameter.file.facts.at(5)).sphere.radius_m, 0.6, 1e-15);
  EXPECT_EQ(diameter.unknown, 2u);  // a size of 0 is none
}

TEST(FactsImport, BadRowsAreNamedWithTheirColumnAndLeaveTheOthers) {
  const auto sizes = import_facts("id,HBR\n1,0.5\nx,0.5\n2,-1\n3\n1,0.6\n4,1e9\n5,abc\n6,0.1\n",
                                  "s", {.id = "id", .size = "HBR", .kind = SizeKind::radius});
  EXPECT_EQ(sizes.file.facts.size(), 2u);
  std::vector<int> lines;
  for (const auto& problem : sizes.file.refused) lines.push_back(problem.line);
  EXPECT_THAT(lines, testing::ElementsAre(3, 4, 5, 6, 7, 8));
  EXPECT_EQ(sizes.file.refused[0].reason, "id is not a number, got \"x\"");
  EXPECT_EQ(sizes.file.refused[1].reason, "HBR out of range, got \"-1\"");
  EXPECT_EQ(sizes.file.refused[3].reason, "a second row of this object, got \"1\"");
}

TEST(FactsImport, MissingColumnsAndUnitsOfAnotherKindAreRefused) {
  EXPECT_EQ(complaint("NORAD_CAT_ID,RCS\n", {.size = "HBR"}),
            "sizes.csv:1: no column HBR, of NORAD_CAT_ID, RCS");
  EXPECT_EQ(complaint("", {.size = "HBR"}), "sizes.csv: has no header");
  EXPECT_EQ(complaint("NORAD_CAT_ID,RCS\n", {.size = "RCS", .kind = SizeKind::rcs}),
            "a radar cross-section is in m2 or dBsm");
  EXPECT_EQ(complaint("NORAD_CAT_ID,RCS\n", {.size = "RCS", .unit = SizeUnit::m2}),
            "a length is in m, cm or mm");
}

TEST(FactsImport, WhatIsWrittenIsWhatAScenarioReads) {
  const auto imported =
      import_facts("NORAD_CAT_ID,l,w,h,a,m\n5,1.1,0.3,2,0.25,7.5\n6,3,,,,\n7,,,,0.1,\n", "s",
                   {.dimensions = {"l", "w", "h"}, .albedo = "a", .standard_magnitude = "m"});
  const std::string csv = facts_csv(imported.file);
  EXPECT_EQ(csv,
            "catalogue_number,standard_magnitude,rcs_m2,length_m,width_m,height_m,albedo\n"
            "5,7.5,,1.1,0.3,2,0.25\n6,,,3,,,\n7,,,,,,0.1\n");
  const auto back = parse_object_facts(csv, "f");
  EXPECT_TRUE(back.refused.empty());
  EXPECT_EQ(facts_csv(back), csv);
}

// NASA CARA's hard-body radii: half of the objects are below 9 cm, 22 times smaller in light than
// the sphere of 1 m that an unknown object is.
TEST(FactsImport, AWholeCatalogueOfHardBodyRadii) {
  const std::string path = test::data_path("validation/sizes/cara_hard_body_radii.csv.gz");
  DMISE_NEEDS_FILE(path);
  const auto sizes = import_facts(read_text_file(path), path,
                                  {.id = "ObjectID", .size = "HBR", .kind = SizeKind::radius});
  EXPECT_EQ(sizes.rows, 58609u);
  EXPECT_TRUE(sizes.file.refused.empty());
  EXPECT_EQ(sizes.file.facts.size(), 23583u);
  EXPECT_NEAR(sphere_of(sizes.file.facts.at(25544)).sphere.radius_m, 66.1, 1e-9);
  std::size_t small = 0;
  for (const auto& [number, facts] : sizes.file.facts)
    small += sphere_of(facts).sphere.radius_m < 0.0834 ? 1 : 0;
  EXPECT_NEAR(double(small) / double(sizes.file.facts.size()), 0.5, 0.01);
}

}  // namespace
}  // namespace dmise
