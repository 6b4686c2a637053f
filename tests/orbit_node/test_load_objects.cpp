#include "orbit-node/load_objects.h"

#include <gmock/gmock.h>

#include "tests/orbit_node/scenario_directory.h"

namespace dmise {
namespace {

using testing::HasSubstr;

const std::string goes =
    "GOES 13\n"
    "1 29155U 06018A   18020.76993589 -.00000277  00000-0  00000+0 0  9990\n"
    "2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737\n";

class ObjectPopulationTest : public test::ScenarioDirectory {
 protected:
  void SetUp() override {
    ScenarioDirectory::SetUp();
    write("goes.tle", goes);
    std::filesystem::copy_file(DMISE_SOURCE_DIR "/launch/scenarios/inspector.oem",
                               directory / "inspector.oem");
  }
  ObjectPopulation population(const std::string& objects,
                              const std::string& place = "site: atlanta") {
    const Scenario scenario = load(objects, place);
    return load_objects(scenario, make_clock(scenario));
  }
};

TEST_F(ObjectPopulationTest, CataloguesComeFirstThenElementsThenTheOtherModels) {
  const auto p = population(
      "  - {name: mast, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}, attitude: nadir,\n"
      "     panel: {hinge: [0, 2, 0], normal: [0, 0, 1]}}\n"
      "  - {name: own, motion: {sgp4: {line1: 1 29156U 06018A   18020.76993589 -.00000277  00000-0 "
      " "
      "00000+0 0  9991, line2: 2 29156   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 "
      "42738}}}\n"
      "  - {catalogue: goes.tle}\n");
  ASSERT_EQ(p.roster.objects.size(), 3u);
  EXPECT_EQ(p.roster.objects[0].name, "GOES 13");
  EXPECT_EQ(p.roster.objects[1].name, "own");
  EXPECT_EQ(p.roster.objects[1].catalogue_number, 29156u);
  EXPECT_NEAR(p.roster.objects[1].element_age_s / 3600, 5.77, 0.01);  // its epoch is day 20.770
  EXPECT_EQ(p.roster.objects[2].name, "mast");
  EXPECT_EQ(p.roster.objects[2].catalogue_number, first_own_number);
  ASSERT_TRUE(p.roster.objects[2].panel);
  EXPECT_EQ(p.roster.objects[2].panel->hinge.y, 1.0);
  EXPECT_EQ(p.elements.size(), 2u);
  EXPECT_EQ(p.models.size(), 1u);
  ASSERT_EQ(p.attitudes.size(), 1u);
  EXPECT_EQ(p.attitudes[0].object, 2u);
}

TEST_F(ObjectPopulationTest, AConstellationIsASourceLikeACatalogue) {
  const auto p = population(
      "  - {walker: {total: 6, planes: 3, height_m: 550.0e+3, inclination_deg: 53}, name: ring, "
      "radius_m: 2, models: {\"ring-2-*\": oneweb}}\n"
      "  - {catalogue: goes.tle}\n"
      "  - {name: mast, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n");
  ASSERT_EQ(p.roster.objects.size(), 8u);
  EXPECT_EQ(p.elements.size(), 7u);
  EXPECT_EQ(p.roster.objects[0].name, "ring-1-1");
  EXPECT_EQ(p.roster.objects[0].catalogue_number, first_own_number + 1);
  EXPECT_EQ(p.roster.objects[0].sphere.radius_m, 2.0);
  EXPECT_EQ(p.roster.objects[5].name, "ring-3-2");
  EXPECT_EQ(p.roster.objects[7].catalogue_number, first_own_number);  // the mast
  EXPECT_EQ(p.attitudes.size(), 2u);                                  // from the model
  EXPECT_EQ(complaint([&] {
              population(
                  "  - {walker: {total: 1, planes: 1, height_m: 550.0e+3, inclination_deg: 53}}\n"
                  "  - {name: walker-1-1, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n");
            }),
            "scenario.yaml:4:12: objects[1].name: a catalogue's object has this name, got "
            "walker-1-1 (give it the number 990000002 to take its place)");
}

TEST_F(ObjectPopulationTest, DebrisAreSpheresOfTheirOwnSize) {
  const auto p = population(
      "  - {population: {min_size_m: 0.05, max_size_m: 0.2, scale: 0.01}, name: d, albedo: 0.3}\n");
  ASSERT_GT(p.elements.size(), 100u);
  const auto& first = p.roster.objects.front();
  EXPECT_EQ(first.catalogue_number, first_own_number);
  EXPECT_NEAR(first.sphere.albedo, 0.3, 1e-12);
  EXPECT_GT(first.sphere.radius_m, 0.05);
  EXPECT_LE(first.sphere.radius_m, 0.1);
  EXPECT_GE(p.roster.objects.back().sphere.radius_m, 0.025);
  EXPECT_LT(p.roster.objects.back().sphere.radius_m, 0.03);
  // Chance may make none.
  EXPECT_TRUE(
      population("  - {population: {min_size_m: 0.0999, scale: 1.0e-9}}\n").elements.empty());
}

TEST_F(ObjectPopulationTest, FragmentsAreSpheresOfTheirOwnSize) {
  const auto p = population(
      "  - {breakup: {parent: mother, kind: explosion, mass_kg: 900, least_length_m: 0.1}, name: "
      "b, "
      "albedo: 0.3}\n"
      "  - {name: mother, motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, "
      "inclination_deg: 98.6}}}\n");
  ASSERT_GT(p.elements.size(), 200u);
  ASSERT_EQ(p.roster.objects.size(), p.elements.size() + 1);
  const auto& first = p.roster.objects.front();
  const auto& last = p.roster.objects[p.elements.size() - 1];
  EXPECT_EQ(first.name, "b-001");
  EXPECT_EQ(first.catalogue_number, first_own_number + 1);
  EXPECT_NEAR(first.sphere.albedo, 0.3, 1e-12);
  EXPECT_GT(first.sphere.radius_m, 5 * last.sphere.radius_m);
  // The area of 0.1 m is 0.556945 * 0.1^2.0047 = 0.00551 m^2.
  EXPECT_NEAR(last.sphere.radius_m, 0.0419, 0.001);
  ASSERT_FALSE(p.notes.empty());
  EXPECT_THAT(p.notes[0], HasSubstr("b: "));
  EXPECT_THAT(p.notes[0], HasSubstr(" fragments of 0.1 m to "));
}

// A model gives an object of a catalogue attitude and panel, here and in a sensor that knows the
// roster alone.
TEST_F(ObjectPopulationTest, AModelTurnsTheObjectsThatItNames) {
  const std::string objects = "  - {catalogue: goes.tle, models: {\"GOES *\": oneweb}}\n";
  const auto p = population(objects);
  ASSERT_EQ(p.attitudes.size(), 1u);
  EXPECT_EQ(p.attitudes[0].object, 0u);
  ASSERT_TRUE(p.roster.objects[0].panel);
  EXPECT_EQ(p.roster.objects[0].panel->hinge.y, 1.0);
  const auto again =
      population_of(published_roster(p), {}, wgs84, models_of(load(objects).objects));
  ASSERT_EQ(again.attitudes.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<NadirAttitude>(again.attitudes[0].model));
  EXPECT_TRUE(
      population("  - {catalogue: goes.tle, models: {\"NOAA *\": oneweb}}\n").attitudes.empty());
}

// Patterns heed case. Those of a shipped model may fit nothing, unless all do.
TEST_F(ObjectPopulationTest, APatternThatFitsNoObjectIsNoted) {
  const auto notes = [&](const std::string& models) {
    return population("  - {catalogue: goes.tle, models: " + models + "}\n").notes;
  };
  EXPECT_THAT(notes("{\"GOES *\": oneweb}"), testing::IsEmpty());
  EXPECT_THAT(notes("{\"goes *\": oneweb, \"29155\": oneweb}"),
              testing::ElementsAre("models: no object of the catalogues has a name or number like "
                                   "goes *"));
  EXPECT_THAT(notes("{\"GOES *\": oneweb, \"ONEWEB-*\": oneweb}"), testing::IsEmpty());
  EXPECT_THAT(notes("shipped"), testing::Contains(HasSubstr("like STARLINK-*")));
}

TEST_F(ObjectPopulationTest, AnObjectOfTwoCataloguesIsTheFirstOnesAndANoteSaysSo) {
  write("newer.tle",
        "NEWER\n"
        "1 29155U 06018A   18021.00000000 -.00000277  00000-0  00000+0 0  9995\n"
        "2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737\n");
  const auto p = population("  - {catalogue: goes.tle}\n  - {catalogue: newer.tle}\n");
  ASSERT_EQ(p.roster.objects.size(), 1u);
  EXPECT_EQ(p.roster.objects[0].name, "GOES 13");
  ASSERT_EQ(p.notes.size(), 1u);
  EXPECT_THAT(p.notes[0], HasSubstr("newer.tle: 1 element set left out: catalogues listed before "
                                    "have the numbers; first 29155 NEWER"));
}

TEST_F(ObjectPopulationTest, OnesOwnObjectTakesThePlaceOfACataloguesWithItsNumber) {
  const std::string own = "motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n";
  const auto p = population(
      "  - {catalogue: goes.tle}\n"
      "  - {name: GOES 13, catalogue_number: 29155, " +
      own);
  ASSERT_EQ(p.roster.objects.size(), 1u);
  EXPECT_EQ(p.models.size(), 1u);
  EXPECT_EQ(complaint([&] { population("  - {catalogue: goes.tle}\n  - {name: GOES 13, " + own); }),
            "scenario.yaml:4:12: objects[1].name: a catalogue's object has this name, got GOES 13 "
            "(give it the number 29155 to take its place)");
}

TEST_F(ObjectPopulationTest, WhatTheFusionNodeIsNotToKnowIsThere) {
  const std::string own = "  - {name: own, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n";
  const auto complaint_of = [&](const std::string& names) {
    return complaint([&] {
      population("  - {catalogue: goes.tle}\n" + own + "fusion: {not_in_catalogue: " + names +
                 "}\n");
    });
  };
  EXPECT_EQ(complaint_of("[GOES 13, own]"), "");
  EXPECT_EQ(complaint_of("[29155]"), "");
  EXPECT_EQ(
      complaint_of("[own, GOES 14]"),
      "scenario.yaml:5:34: fusion.not_in_catalogue[1]: no object has this name or number, did "
      "you mean GOES 13?, got GOES 14");
}

TEST_F(ObjectPopulationTest, ATrajectoryThatMissesTheRunIsRefused) {
  std::ifstream file(directory / "inspector.oem");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  for (auto at = text.find("-21T"); at != text.npos; at = text.find("-21T"))
    text.replace(at, 4, "-22T");
  write("tomorrow.oem", text);
  const auto said =
      complaint([&] { population("  - {name: probe, motion: {oem: tomorrow.oem}}\n"); });
  EXPECT_THAT(said,
              HasSubstr("scenario.yaml:3:12: objects[0].name: tomorrow.oem: the trajectory of "
                        "probe spans 2018-01-22T00:13:00.000 to 2018-01-22T00:19:00.000 UTC"));
  EXPECT_THAT(said, HasSubstr("the run 2018-01-21T00:15:00.000Z to 2018-01-21T00:16:00.000Z"));
}

TEST_F(ObjectPopulationTest, ATrajectoryThatEndsWithinTheRunIsRefusedWhereASensorDependsOnIt) {
  std::ifstream file(directory / "inspector.oem");
  std::string text, line;
  while (std::getline(file, line))
    if (line.find("00:1") == line.npos || line < "2018-01-21T00:15:30") text += line + "\n";
  write("short.oem", text);
  const std::string probe = "  - {name: probe, motion: {oem: short.oem}}\n";
  EXPECT_EQ(population(probe).notes.size(), 1u);
  EXPECT_THAT(complaint([&] { population(probe, "platform: probe"); }),
              HasSubstr("sensor a depends on it"));
}

TEST_F(ObjectPopulationTest, ATableOfAttitudesMustCoverTheRun) {
  write("turns.csv", "time_s,w,x,y,z\n0,1,0,0,0\n59,0,0,1,0\n");
  EXPECT_THAT(complaint([&] {
                population(
                    "  - {name: x, attitude: {table: turns.csv}, motion: {fixed: {gcrs_m: "
                    "[7e6, 0, 0]}}}\n");
              }),
              HasSubstr("turns.csv: the attitudes of x span 0.000000 to 59.000000 s"));
}

}  // namespace
}  // namespace dmise
