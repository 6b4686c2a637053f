#include "core/orbit/elements/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/files/text_file.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

using testing::HasSubstr;

const std::string iss1 = "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927\n";
const std::string iss2 = "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537\n";
const std::string later1 =
    "1 25544U 98067A   08264.61782528 -.00002182  00000-0 -11606-4 0  2928\n";
const std::string van1 = "1     5U 58002B   19352.86539842  .00000184  00000-0  20948-3 0  9994\n";
const std::string van2 = "2     5  34.2610  67.7117 1845282 255.2293  83.7559 10.84789954185624\n";

TEST(Catalogue, NamesComeInThreeStyles) {
  const auto file =
      parse_catalogue("0 ISS (ZARYA)\n" + iss1 + iss2 + "VANGUARD 1      \n" + van1 + van2, "t");
  ASSERT_EQ(file.elements.size(), 2u);
  EXPECT_EQ(file.elements[0].name, "ISS (ZARYA)");
  EXPECT_EQ(file.elements[1].name, "VANGUARD 1");
  EXPECT_EQ(parse_catalogue(iss1 + iss2, "t").elements[0].name, "");
}

TEST(Catalogue, CarriageReturnsByteOrderMarkBlankLinesAndCommentsAreNoTrouble) {
  std::string text = "\xef\xbb\xbf# a comment\n\n0 ISS\n" + iss1 + "\n" + iss2 + "# end\n";
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& t : {text, crlf}) {
    const auto file = parse_catalogue(t, "t");
    ASSERT_EQ(file.elements.size(), 1u);
    EXPECT_EQ(file.elements[0].name, "ISS");
    EXPECT_EQ(file.elements[0], parse_catalogue("ISS\n" + iss1 + iss2, "t").elements[0]);
    EXPECT_TRUE(file.refused.empty());
  }
}

TEST(Catalogue, NewestOfTwoEpochsIsUsedAndTheOtherCounted) {
  for (const std::string& text :
       {iss1 + iss2 + van1 + van2 + later1 + iss2, later1 + iss2 + van1 + van2 + iss1 + iss2}) {
    const auto file = parse_catalogue(text, "t");
    ASSERT_EQ(file.elements.size(), 2u);
    EXPECT_EQ(file.superseded, 1u);
    EXPECT_EQ(file.records(), 3u);
    for (const auto& e : file.elements)
      EXPECT_EQ(e.epoch_jd2, e.catalogue_number == 25544 ? 0.61782528 : 0.86539842);
    EXPECT_EQ(parse_catalogue(text, "t", {.keep_every_epoch = true}).elements.size(), 3u);
  }
}

TEST(Catalogue, RefusedRecordIsNamedWithItsLineAndTakesNoOtherWithIt) {
  std::string wrong = van2;
  wrong[20] = '8';
  const auto file = parse_catalogue("A\n" + van1 + wrong + "B\n" + iss1 + iss2, "some.txt");
  ASSERT_EQ(file.elements.size(), 1u);
  EXPECT_EQ(file.elements[0].name, "B");
  ASSERT_EQ(file.refused.size(), 1u);
  EXPECT_EQ(file.describe(file.refused[0]),
            "some.txt:2: line 2 has a wrong checksum, expected 2, got \"4\"");
}

TEST(Catalogue, NothingIsSilentlyDropped) {
  // Two names in a row; a line 1 alone; a line 2 alone; a name at the end.
  const auto file = parse_catalogue(
      "HEADER\nISS\n" + iss1 + iss2 + "X\n" + van1 + "Y\n" + iss1 + iss2 + van2 + "LAST", "t");
  EXPECT_EQ(file.elements.size(), 1u);
  EXPECT_EQ(file.elements[0].name, "Y");
  EXPECT_EQ(file.superseded, 1u);
  std::vector<int> lines;
  for (const auto& problem : file.refused) lines.push_back(problem.line);
  EXPECT_THAT(lines, testing::ElementsAre(1, 6, 10, 11));
}

TEST(Catalogue, EmptyOrMissingFileIsAnError) {
  EXPECT_THROW(parse_catalogue("", "t"), ConfigError);
  EXPECT_THROW(parse_catalogue("\n# nothing\n", "t"), ConfigError);
  EXPECT_THROW(read_catalogue("/nonexistent/file"), ConfigError);
}

TEST(Catalogue, GpredictSectionsAreRead) {
  const auto file =
      parse_catalogue("\n[25544]\nVERSION=1.1\nNAME=ISS (ZARYA)\nNICKNAME=ISS\nTLE1=" + iss1 +
                          "TLE2=" + iss2 + "\n[7]\nNAME=NOTHING\nTLE1=" + van1,
                      "t");
  EXPECT_EQ(file.format, CatalogueFormat::gpredict);
  ASSERT_EQ(file.elements.size(), 1u);
  EXPECT_EQ(file.elements[0].name, "ISS (ZARYA)");
  ASSERT_EQ(file.refused.size(), 1u);
  EXPECT_EQ(file.describe(file.refused[0]), "t:9: section without TLE1 and TLE2, got \"[7]\"");
}

// Frames, detections and truth of every shipped scenario depend on it.
TEST(Catalogue, TheShippedOneHas979SetsOfJanuary2018) {
  const std::string path = test::catalogue_path("demo.tle");
  EXPECT_EQ(sha256_hex(read_text_file(path)),
            "ddb2baa5d160dbfa69fb723b8dd3548cad1f6a073efb79e8a11c75221ff8532d");
  const auto file = read_catalogue(path);
  EXPECT_EQ(file.elements.size(), 979u);
  EXPECT_EQ(file.records(), 979u);
  const double newest_jd = std::ranges::max(file.elements, {}, [](const MeanElements& e) {
                             return e.epoch_jd1 + e.epoch_jd2;
                           }).epoch_jd1;
  EXPECT_NEAR(newest_jd, 2458140.5, 1.0);  // 2018-01-22
}

TEST(Catalogue, WholePublicCataloguesAreRead) {
  const struct {
    const char* name;
    std::size_t objects;
  } files[] = {{"tle/catalog_3le_2019-12-19_18470.txt.gz", 18470},
               {"tle/leo_3le_2026-06-10_16032.txt.gz", 16032}};
  for (const auto& expected : files) {
    const std::string path = test::data_path(expected.name);
    DMISE_NEEDS_FILE(path);
    const auto file = read_catalogue(path);
    EXPECT_EQ(file.elements.size(), expected.objects);
    EXPECT_TRUE(file.refused.empty());
    for (const auto& e : file.elements) EXPECT_FALSE(e.name.empty());
  }
}

// 458 of the file's 40,300 lines carry a checksum that is not the sum of theirs, in 255 sets.
TEST(Catalogue, SetsWithWrongChecksumsAreCountedAndReadWhenAskedFor) {
  const std::string path = test::data_path("tle/catalog_2le_2020-05-17_20150_badchecksums.txt.gz");
  DMISE_NEEDS_FILE(path);
  const auto strict = read_catalogue(path);
  EXPECT_EQ(strict.elements.size(), 20150u - 255u);
  EXPECT_EQ(strict.refused.size(), 255u);
  const auto lenient = read_catalogue(path, {.lenient = true});
  EXPECT_EQ(lenient.elements.size(), 20150u);
  EXPECT_EQ(lenient.warnings.size(), 255u);
}

// The published verification set: one object twice, five lines with wrong checksums.
TEST(Catalogue, VerificationSetIsReadWhole) {
  const std::string path = test::data_path("sgp4/SGP4-VER.TLE");
  DMISE_NEEDS_FILE(path);
  const auto file = read_catalogue(path, {.lenient = true, .keep_every_epoch = true});
  EXPECT_EQ(file.elements.size(), 33u);
  EXPECT_TRUE(file.refused.empty());
}

TEST(Catalogue, OddAndType4SetsOfTheReferenceAreReadOrRefused) {
  const std::string odd = test::data_path("sgp4/vallado_tough.tle");
  DMISE_NEEDS_FILE(odd);
  EXPECT_EQ(read_catalogue(odd).refused.size(), 121u);  // 68 columns: no checksums
  EXPECT_EQ(read_catalogue(odd, {.lenient = true}).elements.size(), 121u);
  const auto type4 = read_catalogue(test::data_path("sgp4/vallado_datalib_SGP4-VER.TLE"),
                                    {.lenient = true, .keep_every_epoch = true});
  EXPECT_EQ(type4.elements.size(), 33u);
  ASSERT_EQ(type4.refused.size(), 1u);
  EXPECT_THAT(type4.refused[0].reason, HasSubstr("ephemeris type"));
}

}  // namespace
}  // namespace dmise
