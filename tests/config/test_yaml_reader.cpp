#include "core/config/yaml/yaml_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "core/base/error.h"

namespace dmise {
namespace {

std::string complaint(const std::string& text, const std::function<void(YamlMap&)>& read) {
  try {
    YamlMap map(YamlValue::parse(text, "s.yaml"));
    read(map);
    map.done();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(YamlReader, ReadsWhatIsThere) {
  EXPECT_EQ(complaint("a: 1.5\nb: {c: on, d: [x, y]}\n",
                      [](YamlMap& m) {
                        EXPECT_EQ(m.number("a"), 1.5);
                        YamlMap b(m.require("b"));
                        EXPECT_TRUE(b.flag("c"));
                        EXPECT_EQ(b.require("d").list().at(1).text(), "y");
                        b.done();
                      }),
            "");
}

TEST(YamlReader, PointsAtTheValueThatIsWrong) {
  const auto read = [](YamlMap& m) {
    YamlMap(m.require("camera")).number("exposure_s", Bounds::positive());
  };
  EXPECT_EQ(complaint("camera:\n  exposure_s: -1\n", read),
            "s.yaml:2:15: camera.exposure_s: must be > 0, got -1");
  EXPECT_EQ(complaint("camera:\n  exposure_s: fast\n", read),
            "s.yaml:2:15: camera.exposure_s: must be a number, got fast");
  EXPECT_EQ(complaint("camera:\n  exposure_s: .nan\n", read),
            "s.yaml:2:15: camera.exposure_s: must be a number, got .nan");
  EXPECT_EQ(complaint("camera:\n  exposure_s: [1]\n", read),
            "s.yaml:2:15: camera.exposure_s: must be a number, got a list");
  EXPECT_EQ(complaint("camera:\n  gain: 1\n", read), "s.yaml:2:3: camera.exposure_s: is missing");
}

TEST(YamlReader, NamesTheBoundOfAWholeNumberThatIsTooLong) {
  const auto read = [](YamlMap& m) {
    m.require("seed").integer(0, std::numeric_limits<std::int64_t>::max());
  };
  EXPECT_EQ(complaint("seed: 9223372036854775807\n", read), "");
  for (const char* seed : {"9223372036854775808", "18446744073709551615", "1000000000000000000000"})
    EXPECT_EQ(complaint("seed: " + std::string(seed) + "\n", read),
              "s.yaml:1:7: seed: must be <= 9223372036854775807, got " + std::string(seed));
  EXPECT_EQ(complaint("seed: -9223372036854775809\n", read),
            "s.yaml:1:7: seed: must be >= 0, got -9223372036854775809");
  EXPECT_EQ(complaint("seed: 9223372036854775808.5\n", read),
            "s.yaml:1:7: seed: must be a whole number, got 9223372036854775808.5");
}

TEST(YamlReader, RefusesUnknownKeysWithASuggestion) {
  EXPECT_EQ(complaint("exposur_s: 1\n", [](YamlMap& m) { m.find("exposure_s"); }),
            "s.yaml:1:1: exposur_s: unknown key, did you mean exposure_s?");
  EXPECT_EQ(complaint("colour: 1\n", [](YamlMap& m) { m.find("exposure_s"); }),
            "s.yaml:1:1: colour: unknown key");
}

TEST(YamlReader, RefusesAKeyGivenTwice) {
  EXPECT_EQ(complaint("a: {b: 1,\n    b: 2}\n", [](YamlMap& m) { m.find("a"); }),
            "s.yaml:2:5: a.b: key given twice");
}

// The parser notices these lines later: "end of map not found" at the end of the file.
TEST(YamlReader, NamesTheLineWhereBrokenYamlBegins) {
  const std::string words = ": not valid YAML: ";
  const std::pair<const char*, std::string> cases[] = {
      {"a: [1, 2\nb: 3\n", "1:4" + words + "the bracket [ is not closed"},
      {"a: 1\nlist:\n  - {x: 1, y: {z: [2]}\n  - {x: 2}\nb: 3\n",
       "3:5" + words + "the bracket { is not closed"},
      {"a: {x: [1, 2}\nb: 3\n", "1:8" + words + "the bracket [ is closed by } in line 1"},
      {"a:\n  b: 1\n\tc: 2\nd: 3\n",
       "3:1" + words + "a tab in the indentation, which must be of spaces"},
      {"t: |\n  {[\n# {\nq: 'it''s {'\np: a{b\nz: {y: 1\n",
       "6:4" + words + "the bracket { is not closed"}};
  for (const auto& [text, said] : cases)
    EXPECT_EQ(complaint(text, [](YamlMap&) {}), "s.yaml:" + said) << text;
  // What the scan has no opinion of is as the parser says, with a hint.
  EXPECT_THAT(complaint("list:\n  - a: 1\n   b: 2\n", [](YamlMap&) {}),
              testing::HasSubstr("is this line indented as those before it?"));
}

TEST(YamlReader, EveryChoiceHasASuggestion) {
  const std::vector<std::string_view> words{"wait", "fail", "drop"};
  EXPECT_EQ(complaint("a: wiat\n", [&](YamlMap& m) { m.require("a").choice(words); }),
            "s.yaml:1:4: a: must be one of wait, fail, drop, did you mean wait?, got wiat");
  EXPECT_EQ(complaint("a: offf\n", [](YamlMap& m) { m.flag("a"); }),
            "s.yaml:1:4: a: must be on or off, did you mean off?, got offf");
  EXPECT_EQ(nearest_name("unifrom", {"uniform"}), "uniform");
  EXPECT_EQ(nearest_name("4", {"3", "5"}), "");
}

TEST(YamlReader, ReportsBrokenYamlWithItsPlace) {
  EXPECT_TRUE(complaint("a: 1\n b: 3\n", [](YamlMap&) {}).starts_with("s.yaml:2:"));
  EXPECT_EQ(complaint("- 1\n", [](YamlMap&) {}), "s.yaml:1:1: must be a mapping of keys to values");
}

TEST(YamlReader, SuggestsOnlyWhatIsNear) {
  EXPECT_EQ(nearest_name("omnisa", {"omnissa", "raven"}), "omnissa");
  EXPECT_EQ(nearest_name("telescope", {"omnissa", "raven"}), "");
}

}  // namespace
}  // namespace dmise
