#include "core/config/yaml/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/error.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

YamlValue value(const std::string& text) {
  return YamlMap(YamlValue::parse("x: " + text, "s.yaml")).require("x");
}

std::string complaint(const std::string& text) {
  try {
    Distribution{value(text)};
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

std::vector<double> draws(const std::string& text, std::uint64_t count) {
  const Distribution distribution(value(text));
  std::vector<double> x;
  for (std::uint64_t seed = 1; seed <= count; ++seed)
    x.push_back(std::stod(distribution.draw(rng_key(seed, "dataset", 0, "x")).scalar));
  return x;
}

/// Kolmogorov-Smirnov: sqrt(n) D is above 1.628 with a probability of 0.01.
double ks_distance(std::vector<double> x, const std::function<double(double)>& cdf) {
  std::sort(x.begin(), x.end());
  double distance = 0.0;
  const double n = double(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p = cdf(x[i]);
    distance = std::max({distance, double(i + 1) / n - p, p - double(i) / n});
  }
  return std::sqrt(n) * distance;
}
constexpr double at_one_percent = 1.628;
constexpr std::uint64_t many = 20'000;

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

TEST(Distribution, DrawsFollowTheirDistributions) {
  EXPECT_LT(ks_distance(draws("{uniform: [-3, 7]}", many), [](double x) { return (x + 3) / 10; }),
            at_one_percent);
  EXPECT_LT(ks_distance(draws("{log_uniform: [0.01, 100]}", many),
                        [](double x) { return std::log(x / 0.01) / std::log(1e4); }),
            at_one_percent);
  EXPECT_LT(ks_distance(draws("{normal: {mean: 4, sigma: 0.5}}", many),
                        [](double x) { return normal_cdf((x - 4) / 0.5); }),
            at_one_percent);
  const double below = normal_cdf(-1), within = normal_cdf(2) - below;
  EXPECT_LT(ks_distance(draws("{normal: {mean: 4, sigma: 0.5, min: 3.5, max: 5}}", many),
                        [&](double x) { return (normal_cdf((x - 4) / 0.5) - below) / within; }),
            at_one_percent);
}

TEST(Distribution, IntegersAndChoicesAreEquallyLikely) {
  const auto chi_square = [](const std::vector<int>& counts) {
    const double expected = double(many) / double(counts.size());
    double sum = 0.0;
    for (const int n : counts) sum += (n - expected) * (n - expected) / expected;
    return sum;
  };
  std::vector<int> counts(5);
  for (const double x : draws("{integers: [-2, 2]}", many)) ++counts[std::size_t(x + 2)];
  EXPECT_LT(chi_square(counts), 13.28);  // 1 % of 4 degrees of freedom
  const Distribution choices(value("{one_of: [a, b, {c: 1}]}"));
  std::vector<int> taken(3);
  for (std::uint64_t seed = 1; seed <= many; ++seed)
    ++taken[std::size_t(choices.draw(rng_key(seed, "dataset", 0, "x")).choice)];
  EXPECT_LT(chi_square(taken), 9.21);  // 1 % of 2 degrees of freedom
}

TEST(Distribution, TimesAreUniformBetweenTwoDates) {
  const Distribution times(value("{uniform: [2016-12-31T23:59:50Z, 2017-01-01T00:00:10Z]}"));
  const Clock clock(parse_utc("2016-12-31T23:59:50Z"));  // 21 s: one is a leap second
  std::vector<double> x;
  for (std::uint64_t seed = 1; seed <= many; ++seed)
    x.push_back(
        clock.sim_time(parse_utc(times.draw(rng_key(seed, "dataset", 0, "x")).scalar)).seconds());
  EXPECT_LT(ks_distance(x, [](double t) { return t / 21; }), at_one_percent);
}

TEST(Distribution, AKeyGivesItsValueWhateverElseIsDrawn) {
  const Distribution one(value("{uniform: [0, 1]}"));
  const auto draw = [&](std::uint64_t seed, const char* path) {
    return one.draw(rng_key(seed, "dataset", 0, path)).scalar;
  };
  EXPECT_EQ(draw(7, "a"), draw(7, "a"));
  EXPECT_NE(draw(7, "a"), draw(7, "b"));
  EXPECT_NE(draw(7, "a"), draw(8, "a"));
}

TEST(Distribution, EndsAreWithinTheRange) {
  const Distribution narrow(value("{uniform: [0.1234567890123456, 0.1234567890123457]}"));
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const double x = std::stod(narrow.draw(rng_key(seed, "dataset", 0, "x")).scalar);
    EXPECT_GE(x, 0.1234567890123456);
    EXPECT_LE(x, 0.1234567890123457);
  }
}

TEST(Distribution, EndsOfALogarithmMayBeFurtherApartThanANumberCanSay) {
  EXPECT_LT(ks_distance(draws("{log_uniform: [1e-306, 1000]}", many),
                        [](double x) { return (std::log10(x) + 306) / 309; }),
            at_one_percent);
  EXPECT_NEAR(
      std::log10(std::stod(Distribution(value("{log_uniform: [1e-306, 1000]}")).middle().scalar)),
      -151.5, 1e-9);
}

TEST(Distribution, WhatExceedsAllNumbersIsInfiniteAndNoFault) {
  const Distribution wide(value("{normal: {mean: 0, sigma: 1e308}}"));
  for (const auto& end : wide.ends())
    EXPECT_NE(end.scalar.find("inf"), std::string::npos) << end.scalar;
}

TEST(Distribution, OtherMappingsAreNone) {
  for (const char* text : {"{uniform: off}", "{normal: [0, 0, 1]}", "{mean: 2}", "3", "[1, 2]",
                           "{uniform: [1, 2], min: 3}"})
    EXPECT_FALSE(Distribution::is(value(text).node())) << text;
}

TEST(Distribution, WhatCannotBeIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"{uniform: [2, 1]}", "s.yaml:1:18: x.uniform[1]: must be > 2, got 1"},
      {"{uniform: [1, 1]}", "x.uniform[1]: must be > 1, got 1"},
      {"{uniform: [1, 2, 3]}", "s.yaml:1:14: x.uniform: must be a list of two, [least, most]"},
      {"{uniform: [1, b]}", "x.uniform[1]: must be a number, got b"},
      {"{uniform: [-1e308, 1e308]}", "wider than a number"},
      {"{uniform: [2018-01-02T00:00:00Z, 2018-01-01T00:00:00Z]}", "must be > 2018-01-02"},
      {"{uniform: [2018-02-30T00:00:00Z, 2018-03-01T00:00:00Z]}",
       "x.uniform[0]: must be a UTC time such as"},
      {"{uniform: [1960-01-21T10:00:00Z, 2018-01-21T10:00:00Z]}",
       "s.yaml:1:15: x.uniform[0]: must not be before 1972, when UTC was not yet whole seconds "
       "from "
       "TAI, got 1960-01-21T10:00:00Z"},
      {"{uniform: [1972-01-02T00:00:00Z, 9999-01-01T00:00:00Z]}",
       "s.yaml:1:37: x.uniform[1]: 9999-01-01T00:00:00Z: is more than 292 years from 1972-01-02"},
      {"{uniform: [2018-01-02T00:00:00Z, 5]}", "x.uniform[1]: must be a UTC time such as"},
      {"{log_uniform: [0, 1]}", "x.log_uniform[0]: must be > 0, got 0"},
      {"{integers: [1, 2.5]}", "x.integers[1]: must be a whole number, got 2.5"},
      {"{integers: [3, 1]}", "x.integers[1]: must be > 3, got 1"},
      {"{one_of: []}", "x.one_of: must have a choice"},
      {"{normal: {mean: 1}}", "x.normal.sigma: is missing"},
      {"{normal: {mean: 1, sigma: 0}}", "x.normal.sigma: must be > 0, got 0"},
      {"{normal: {mean: 1, sigma: 1, least: 0}}", "unknown key"},
      {"{normal: {mean: 0, sigma: 1, min: 5, max: 6}}", "less than 1 % between min and max"},
      {"{normal: {mean: 0, sigma: 1, min: 1, max: 0}}", "x.normal.max: must be > min, got 0"},
  };
  for (const auto& [text, message] : cases)
    EXPECT_NE(complaint(text).find(message), std::string::npos) << text << "\n" << complaint(text);
}

}  // namespace
}  // namespace dmise
