#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/sky/variables/gcvs_file.h"
#include "tests/sky/gcvs_rows.h"
#include "tests/support/config_error.h"

namespace dmise {
namespace {

/// Spica as GCVS has it: a magnitude at maximum, and amplitudes.
const std::string spica =
    "869001 |alf   Vir *|132511.6-110941 |ELL+BCEP  |  0.95   |(  0.10    )|(  0.08    )|V "
    "|19530.49    |     |     4.014604       |     |B1III-IV+B2V     |04627 BD   |";

VariableRecord one(const std::string& line) {
  const VariableReading reading = parse_gcvs(line + "\n", "gcvs5.txt");
  EXPECT_TRUE(reading.problems.empty()) << reading.problems[0];
  return reading.stars.at(0);
}

std::string with(std::string line, const std::string& from, const std::string& to) {
  return line.replace(line.find(from), from.size(), to);
}

TEST(GcvsFile, HasTheElementsOfAStar) {
  const VariableReading reading = parse_gcvs(test::gcvs_rows, "gcvs5.txt");
  ASSERT_EQ(reading.stars.size(), 9u);
  EXPECT_TRUE(reading.problems.empty());
  const VariableRecord& algol = reading.stars[5];
  EXPECT_EQ(algol.name, "bet Per");
  EXPECT_EQ(algol.type, "EA/SD");
  EXPECT_EQ(algol.band, "V");
  EXPECT_NEAR(algol.ra_rad / deg, 47.0422, 1e-4);  // Hipparcos 14576
  EXPECT_NEAR(algol.dec_rad / deg, 40.9556, 1e-4);
  EXPECT_DOUBLE_EQ(*algol.brightest_mag, 2.12);
  EXPECT_NEAR(*algol.depth_mag, 1.27, 1e-12);
  EXPECT_FALSE(algol.second_depth_mag);
  EXPECT_DOUBLE_EQ(*algol.epoch_hjd, 2445641.5135);
  EXPECT_DOUBLE_EQ(*algol.period_d, 2.8673043);
  EXPECT_NEAR(*algol.share_of_period, 0.14, 1e-12);
  EXPECT_NEAR(*reading.stars[6].second_depth_mag, 0.68, 1e-12);  // W UMa
  EXPECT_FALSE(reading.stars[4].epoch_hjd);                      // Betelgeuse
}

// The form of earlier versions, and of CDS: places without a blank.
TEST(GcvsFile, ReadsAmplitudesInBrackets) {
  const VariableRecord star = one(spica);
  EXPECT_NEAR(star.ra_rad / deg, 201.2983, 1e-4);
  EXPECT_NEAR(star.dec_rad / deg, -11.1614, 1e-4);
  EXPECT_NEAR(*star.depth_mag, 0.10, 1e-12);
  EXPECT_NEAR(*star.second_depth_mag, 0.08, 1e-12);
}

TEST(GcvsFile, ReadsSignsOfQuality) {
  EXPECT_DOUBLE_EQ(*one(with(spica, "  0.95   ", "< 0.95:  ")).brightest_mag, 0.95);
  EXPECT_DOUBLE_EQ(*one(with(spica, "19530.49    ", "19530.49   :")).epoch_hjd, 2419530.49);
  EXPECT_DOUBLE_EQ(*one(with(spica, "4.014604  ", "4.014604*N")).period_d, 4.014604);
  EXPECT_FALSE(one(with(spica, "    4.014604", "  > 4.014604")).period_d);
  EXPECT_FALSE(one(with(spica, "19530.49    ", "           :")).epoch_hjd);
  EXPECT_FALSE(one(with(spica, "(  0.08    )", "            ")).second_depth_mag);
}

TEST(GcvsFile, PassesOverHeadingsAndStarsWithoutAPlace) {
  const VariableReading reading =
      parse_gcvs("# VizieR\nGCVS | name | J2000.0\n---\n" + spica + "\n" +
                     with(spica, "132511.6-110941", "               ") + "\n\n",
                 "f");
  EXPECT_EQ(reading.stars.size(), 1u);
  EXPECT_EQ(reading.without_place, 1u);
  EXPECT_TRUE(reading.problems.empty());
}

TEST(GcvsFile, NamesLineAndColumnOfWhatIsWrong) {
  const auto problem = [](const std::string& line) {
    const VariableReading reading = parse_gcvs(spica + "\n" + line + "\n", "gcvs5.txt");
    EXPECT_EQ(reading.stars.size(), 1u) << line;
    return reading.problems.size() == 1 ? reading.problems[0] : "no problem";
  };
  EXPECT_EQ(problem(with(spica, "132511.6-110941", "132571.6-110941")),
            "gcvs5.txt:2:21: must be a place, hhmmss.ss +ddmmss.s, got \"132571.6-110941\"");
  EXPECT_EQ(problem(with(spica, "  0.95   ", "  o.95   ")),
            "gcvs5.txt:2:51: must be a magnitude, got \"o.95\"");
  EXPECT_EQ(problem(with(spica, "4.014604", "-4.01460")),
            "gcvs5.txt:2:112: must be a period [d], got \"-4.01460\"");
  EXPECT_EQ(problem(with(spica, "19530.49    ", "2419530.49  ")),
            "gcvs5.txt:2:88: must be a Julian date less 2400000, got \"2419530.49\"");
  EXPECT_EQ(problem("869002 |alf   Vir *|132511.6-110941 |ELL"),
            "gcvs5.txt:2:38: the line has 4 of 12 fields between bars");
  EXPECT_EQ(problem("Spica"), "gcvs5.txt:2:1: must be the number of a star, got \"Spica\"");
}

TEST(GcvsFile, ThatHasNoStarIsRefused) {
  EXPECT_EQ(test::config_error_of([] { parse_gcvs("ra,dec\nx,y\n", "f.csv"); }),
            "f.csv:1:1: no variable star in it; it must be the General Catalogue of Variable "
            "Stars (gcvs5.txt, or gcvs_cat.dat)");
  EXPECT_EQ(test::config_error_of([] { parse_gcvs("1,2\n", "f.csv"); }),
            "f.csv:1:1: the line has 1 of 12 fields between bars");
}

}  // namespace
}  // namespace dmise
