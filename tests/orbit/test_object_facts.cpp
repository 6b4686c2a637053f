#include "core/orbit/elements/object_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

TEST(ObjectFacts, RowsAreReadByTheirHeaderAndBlanksAreUnknown) {
  const auto file = parse_object_facts(
      "NORAD_CAT_ID,name,Standard_Magnitude,rcs_m2,length_m,width_m,height_m,albedo\n"
      "25544,\"ISS, whole\",-1.8,399,73,109,27,\n"
      "100831,x,,,,,,0.3\n",
      "f.csv");
  ASSERT_EQ(file.facts.size(), 2u);
  const ObjectFacts& iss = file.facts.at(25544);
  EXPECT_EQ(iss.standard_magnitude, -1.8);
  EXPECT_EQ(iss.rcs_m2, 399);
  EXPECT_EQ(iss.dimensions_m[1], 109);
  EXPECT_FALSE(iss.albedo);
  EXPECT_FALSE(file.facts.at(100831).standard_magnitude);
  EXPECT_TRUE(file.refused.empty());
}

TEST(ObjectFacts, BadRowsAreNamedAndLeaveTheOthers) {
  const auto file = parse_object_facts(
      "catalogue_number,albedo\n1,0.2\n2,1.5\nx,0.2\n1,0.3\n5\n6,0.4\n", "f.csv");
  EXPECT_EQ(file.facts.size(), 2u);
  std::vector<int> lines;
  for (const auto& problem : file.refused) lines.push_back(problem.line);
  EXPECT_THAT(lines, testing::ElementsAre(3, 4, 5, 6));
  EXPECT_EQ(file.refused[0].reason, "albedo out of range, got \"1.5\"");
  EXPECT_THROW(parse_object_facts("a,b\n1,2\n", "f.csv"), ConfigError);
  EXPECT_THROW(parse_object_facts("", "f.csv"), ConfigError);
}

// physics.md's case: radius 1 m, reflectance 0.2, 1000 km, half lit: V = 6.67.
TEST(ObjectFacts, StandardMagnitudeMakesTheSphereOfThatBrightness) {
  const ObjectSphere s = sphere_of({.standard_magnitude = 6.67});
  EXPECT_EQ(s.source, BrightnessSource::standard_magnitude);
  EXPECT_NEAR(s.sphere.radius_m, 1.0, 0.005);
  EXPECT_EQ(s.sphere.albedo, 0.2);
  const ObjectSphere dark = sphere_of({.standard_magnitude = 6.67, .albedo = 0.05});
  EXPECT_NEAR(dark.sphere.radius_m, 2.0, 0.01);
}

TEST(ObjectFacts, DimensionsMakeTheSphereOfTheMeanCrossSection) {
  EXPECT_NEAR(sphere_of({.dimensions_m = {3, 0, 0}}).sphere.radius_m, 1.5, 1e-12);
  // A cube of 2 m: a quarter of 24 m2. A cylinder 4 m long, 2 m wide: a quarter of 10 pi m2.
  EXPECT_NEAR(sphere_of({.dimensions_m = {2, 2, 2}}).sphere.radius_m, std::sqrt(6 / pi), 1e-12);
  EXPECT_NEAR(sphere_of({.dimensions_m = {2, 4, 0}}).sphere.radius_m, std::sqrt(2.5), 1e-12);
  EXPECT_EQ(sphere_of({.dimensions_m = {2, 2, 2}}).source, BrightnessSource::dimensions);
}

TEST(ObjectFacts, RadarCrossSectionAndThenTheDefaultStandIn) {
  const ObjectSphere radar = sphere_of({.rcs_m2 = 4 * pi});
  EXPECT_EQ(radar.source, BrightnessSource::rcs);
  EXPECT_NEAR(radar.sphere.radius_m, 2, 1e-12);
  const ObjectSphere nothing = sphere_of({}, {.radius_m = 0.5, .albedo = 0.1});
  EXPECT_EQ(nothing.source, BrightnessSource::none);
  EXPECT_EQ(nothing.sphere.radius_m, 0.5);
}

}  // namespace
}  // namespace dmise
