#include "core/config/yaml/yaml_limits.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

std::string refusal(const std::string& text, const YamlLimits& limits = {}) {
  try {
    check_yaml_limits(text, "s.yaml", limits);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

// YAML 1.2, 7.1: an alias may stand within what it refers to; no configuration is such a circle.
TEST(YamlLimits, RefusesCircles) {
  EXPECT_EQ(refusal("a: &a [*a]\n"), "s.yaml:1:8: an alias within its own anchor");
  EXPECT_EQ(refusal("a: &a {b: {c: [1, *a]}}\n"), "s.yaml:1:19: an alias within its own anchor");
  EXPECT_EQ(refusal("&r\na: *r\n"), "s.yaml:2:4: an alias within its own anchor");
  EXPECT_THROW(YamlValue::parse("a: &a [*a]\n", "s.yaml"), ConfigError);
}

TEST(YamlLimits, LetsAliasesOfWhatIsClosedPass) {
  EXPECT_EQ(refusal("a: &a [1, 2]\nb: *a\nc: [*a, *a]\n"), "");
  EXPECT_EQ(refusal("a: &x 1\nb: &x 2\nc: *x\n"), "");
}

/// Nine lines of ten aliases each: the "billion laughs". 10^k values stand for line k.
std::string laughs(int lines) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int k = 1; k < lines; ++k) {
    const std::string mine = "a" + std::to_string(k), last = "*a" + std::to_string(k - 1);
    text += mine + ": &" + mine + " [";
    for (int i = 0; i < 10; ++i) text += (i ? ", " : "") + last;
    text += "]\n";
  }
  return text;
}

TEST(YamlLimits, CountsWhatAliasesStandFor) {
  EXPECT_EQ(refusal(laughs(3)), "");
  EXPECT_EQ(refusal(laughs(5)), "");
  EXPECT_TRUE(refusal(laughs(9)).ends_with("more than 500000 values, aliases expanded"));
  EXPECT_TRUE(refusal(laughs(9)).starts_with("s.yaml:6:"));  // 10^6 values are complete there
  EXPECT_TRUE(refusal(laughs(60)).starts_with("s.yaml:6:"));
}

// With k values in all, the bound k passes and k - 1 does not: keys, values, lists and mappings.
TEST(YamlLimits, CountsEveryValueOnce) {
  EXPECT_EQ(refusal("a: [1, ~, {b: 2}]\n", {.values = 8}), "");
  EXPECT_EQ(refusal("a: [1, ~, {b: 2}]\n", {.values = 7}),
            "s.yaml:1:15: more than 7 values, aliases expanded");
}

TEST(YamlLimits, BoundsDepthAlsoThroughAliases) {
  const auto nested = [](int depth) {
    return "a: " + std::string(std::size_t(depth - 1), '[') +
           std::string(std::size_t(depth - 1), ']') + "\n";
  };
  EXPECT_EQ(refusal(nested(64)), "");
  EXPECT_EQ(refusal(nested(65)), "s.yaml:1:67: lists and mappings nested deeper than 64");
  EXPECT_TRUE(refusal(nested(1'000'000)).ends_with("deeper than 64"));
  // Each line is one deeper than the one that it names.
  std::string text = "a0: &a0 [1]\n";
  for (int k = 1; k < 70; ++k)
    text += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [*a" + std::to_string(k - 1) +
            "]\n";
  EXPECT_TRUE(refusal(text).starts_with("s.yaml:64:"));
}

TEST(YamlLimits, BoundsALongList) {
  std::string text = "a: [";
  while (text.size() < 15'000'000) text += "1, ";
  EXPECT_TRUE(refusal(text + "1]\n").ends_with("more than 500000 values, aliases expanded"));
}

TEST(YamlLimits, RefusesASecondDocument) {
  EXPECT_EQ(refusal("a: 1\n---\nb: 2\n"),
            "s.yaml:2:1: must be one YAML document, this begins another");
  EXPECT_EQ(refusal("---\na: 1\n...\n"), "");
}

TEST(YamlLimits, ShowsNamesAndValuesOnOneLine) {
  const std::string text = "\"a\\e[2J\\nb\": \"c\\nd\"\n";
  try {
    YamlMap map(YamlValue::parse(text, "s\n.yaml"));
    map.require("a\x1b[2J\nb").number();
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_STREQ(e.what(), "s\\n.yaml:1:14: a\\x1b[2J\\nb: must be a number, got c\\nd");
  }
}

}  // namespace
}  // namespace dmise
