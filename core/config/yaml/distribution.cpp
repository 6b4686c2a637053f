#include "core/config/yaml/distribution.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/nearest_name.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double far_sigmas = 5.0;      // where a normal without ends is tried
constexpr double min_share = 0.01;      // least part of a normal between min and max
constexpr double max_integer = 0x1p53;  // exact in double
constexpr std::uint32_t max_draws = 10'000;
const std::vector<std::string> of_lists{"uniform", "log_uniform", "integers", "one_of"};

/// Uniform in (0, 1) with 53 bits.
double uniform_53(const RngKey& key, std::uint32_t draw) {
  const std::uint64_t bits = std::uint64_t(rng_word(key, 0, draw)) << 32 | rng_word(key, 1, draw);
  return (double(bits >> 11) + 0.5) * 0x1p-53;
}

std::optional<Utc> time_in(const YamlValue& value) {
  if (!value.is_scalar()) return std::nullopt;
  try {
    return parse_utc(value.node().Scalar());
  } catch (const BeforeLeapSeconds&) {
    return value.time();  // throws, with place and reason
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::vector<YamlValue> two_ends(const YamlValue& value) {
  const auto ends = value.is_list() ? value.list() : std::vector<YamlValue>{};
  if (ends.size() != 2) value.fail("must be a list of two, [least, most]");
  return ends;
}

double share_below(double sigmas) { return 0.5 * std::erfc(-sigmas / std::sqrt(2.0)); }

}  // namespace

bool Distribution::is(const YAML::Node& node) {
  if (!node.IsMap() || node.size() != 1) return false;
  const auto entry = node.begin();
  if (!entry->first.IsScalar()) return false;
  const std::string& name = entry->first.Scalar();
  if (name == "normal") return entry->second.IsMap();  // a panel's `normal` is a list
  return entry->second.IsSequence() && std::ranges::find(of_lists, name) != of_lists.end();
}

std::string Distribution::meant_by(const YAML::Node& node) {
  if (!node.IsMap() || node.size() != 1 || is(node)) return "";
  const auto entry = node.begin();
  if (!entry->first.IsScalar()) return "";
  const std::string& name = entry->first.Scalar();
  const std::vector<std::string> names =
      entry->second.IsSequence() ? of_lists : std::vector<std::string>{"normal"};
  if (name == "normal" || entry->second.IsScalar() || entry->second.IsNull()) return "";
  return nearest_name(name, names);
}

void Distribution::refuse_misspelt(const YamlValue& value) {
  if (const std::string meant = meant_by(value.node()); !meant.empty())
    YamlMap(value)
        .require(value.node().begin()->first.Scalar())
        .fail("unknown key, did you mean " + meant + "?", false);
}

Distribution::Distribution(const YamlValue& value) : value_(value) {
  YamlMap map(value);
  name_ = map.keys().front();
  const YamlValue range = map.require(name_);
  if (name_ == "one_of") {
    kind_ = Kind::one_of;
    count_ = range.list().size();
    if (count_ == 0) range.fail("must have a choice", false);
    return;
  }
  if (name_ == "normal") {
    kind_ = Kind::normal;
    YamlMap of(range);
    mean_ = of.number("mean");
    sigma_ = of.number("sigma", Bounds::positive());
    const auto least = of.find("min"), most = of.find("max");
    of.done();
    least_ = least ? least->number() : -std::numeric_limits<double>::infinity();
    most_ = most ? most->number() : std::numeric_limits<double>::infinity();
    if (most && !(least_ < most_)) most->fail("must be > min");
    if (share_below((most_ - mean_) / sigma_) - share_below((least_ - mean_) / sigma_) < min_share)
      range.fail("has less than 1 % between min and max", false);
    return;
  }
  const auto ends = two_ends(range);
  const auto begin = time_in(ends[0]), end = time_in(ends[1]);
  if (name_ == "uniform" && begin && end) {
    kind_ = Kind::time;
    from_ = ends[0].text();
    try {
      most_ = Clock(*begin).sim_time(*end).seconds();
    } catch (const Error& e) {
      ends[1].fail(e.what(), false);
    }
  } else if (name_ == "integers") {
    kind_ = Kind::integers;
    const std::int64_t limit = std::int64_t(max_integer);
    least_ = double(ends[0].integer(-limit, limit));
    most_ = double(ends[1].integer(-limit, limit));
  } else {
    kind_ = name_ == "uniform" ? Kind::uniform : Kind::log_uniform;
    if (name_ == "uniform" && (begin || end))
      ends[begin ? 1 : 0].fail("must be a UTC time such as 2018-01-21T00:30:00Z, as the other end");
    const Bounds bounds = kind_ == Kind::uniform ? Bounds{} : Bounds::positive();
    least_ = ends[0].number(bounds);
    most_ = ends[1].number(bounds);
    if (!std::isfinite(most_ - least_)) range.fail("is wider than a number can be", false);
  }
  if (!(least_ < most_)) ends[1].fail("must be > " + ends[0].node().Scalar());
}

std::vector<YamlValue> Distribution::choices() const {
  return kind_ == Kind::one_of ? YamlMap(value_).require(name_).list() : std::vector<YamlValue>{};
}

std::string Distribution::scalar(double x) const {
  if (kind_ == Kind::time) return format_utc(Clock(parse_utc(from_)).utc(sim_seconds(x)), 6);
  // 12 digits: what the last bits of a logarithm are differs between processors.
  const std::string text = formatted(kind_ == Kind::integers ? "%.0f" : "%.12g", x);
  const double rounded = parse_real(text).value_or(x);  // infinite: not a number of a file
  if (rounded >= least_ && rounded <= most_) return text;
  return shortest_text(rounded < least_ ? least_ : most_);
}

Distribution::Value Distribution::at(double share) const {
  switch (kind_) {
    case Kind::one_of:
      return {.scalar = {},
              .choice = std::min(int(share * double(count_)), int(count_) - 1),
              .what = {}};
    case Kind::integers:
      return {.scalar = scalar(std::min(least_ + std::floor(share * (most_ - least_ + 1)), most_))};
    case Kind::log_uniform: {
      const double ratio = most_ / least_;  // may exceed all numbers
      const double width =
          std::isfinite(ratio) ? std::log(ratio) : std::log(most_) - std::log(least_);
      return {.scalar = scalar(std::exp(std::log(least_) + share * width))};
    }
    case Kind::normal:  // drawn otherwise: only the middle
      return {.scalar = scalar(std::clamp(mean_, least_, most_))};
    case Kind::uniform:
    case Kind::time:
      break;
  }
  return {.scalar = scalar(least_ + share * (most_ - least_))};
}

Distribution::Value Distribution::draw(const RngKey& key) const {
  if (kind_ != Kind::normal) return at(uniform_53(key, 0));
  for (std::uint32_t draw = 0; draw < max_draws; ++draw) {
    const double x = mean_ + sigma_ * double(normal_of(rng_word(key, 0, draw)));
    if (x >= least_ && x <= most_) return {.scalar = scalar(x)};
  }
  value_.fail("none of 10000 draws lies between min and max", false);
}

Distribution::Value Distribution::middle() const {
  return kind_ == Kind::one_of ? Value{.scalar = {}, .choice = 0, .what = {}} : at(0.5);
}

std::vector<Distribution::Value> Distribution::ends() const {
  std::vector<Value> values;
  if (kind_ == Kind::one_of) {
    for (int k = 0; k < int(count_); ++k)
      values.push_back({.scalar = {},
                        .choice = k,
                        .what = "choice " + std::to_string(k + 1) + " of its one_of"});
    return values;
  }
  const auto add = [&](double end, double otherwise, const char* which, const char* key) {
    const bool has = std::isfinite(end);
    values.push_back(
        {.scalar = scalar(has ? end : otherwise),
         .what = has ? std::string(which) + " of its " + name_
                     : "5 sigma from the mean of its normal, which has no " + std::string(key)});
  };
  add(least_, mean_ - far_sigmas * sigma_, "the least", "min");
  add(most_, mean_ + far_sigmas * sigma_, "the most", "max");
  return values;
}

namespace {

bool has_distribution(const YAML::Node& node) {
  if (Distribution::is(node) || !Distribution::meant_by(node).empty()) return true;
  if (node.IsMap())
    return std::any_of(node.begin(), node.end(),
                       [](const auto& entry) { return has_distribution(entry.second); });
  return node.IsSequence() &&
         std::any_of(node.begin(), node.end(), [](const auto& n) { return has_distribution(n); });
}

void refuse_within(const YamlValue& value, const std::string& reason) {
  Distribution::refuse_misspelt(value);
  if (Distribution::is(value.node()))
    value.fail("is a distribution (" + YamlMap(value).keys().front() + "): " + reason, false);
  if (value.is_map()) {
    YamlMap map(value);
    for (const auto& key : map.keys()) refuse_within(map.require(key), reason);
  } else if (value.is_list()) {
    for (const auto& item : value.list()) refuse_within(item, reason);
  }
}

}  // namespace

void refuse_distributions(const YamlValue& root, const std::string& reason) {
  if (has_distribution(root.node())) refuse_within(root, reason);
}

}  // namespace dmise
