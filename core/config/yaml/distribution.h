#pragma once
#include <string>
#include <vector>

#include "core/base/numeric/rng.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {

/// What a value of a scenario is drawn from. A mapping with one of the keys
///   uniform: [least, most]        numbers, or two times
///   log_uniform: [least, most]    positive numbers; the logarithm is uniform
///   normal: {mean:, sigma:, min:, max:}    min and max may be left out
///   integers: [least, most]       whole numbers, both ends included
///   one_of: [a, b, ..]            any values, equally likely
class Distribution {
 public:
  /// What a distribution gave: a scalar, or one of its choices.
  struct Value {
    std::string scalar;  // without a choice
    int choice = -1;     // index of the choice; -1: a scalar
    std::string what;    // from `ends` alone: "the least of its uniform"
  };

  /// Whether a value is a distribution, well-formed or not.
  static bool is(const YAML::Node& node);
  /// Name of the distribution that a value has the form of, under a name that is near; else empty.
  static std::string meant_by(const YAML::Node& node);
  /// Throws `ConfigError` with that name if there is one.
  static void refuse_misspelt(const YamlValue& value);
  /// Throws `ConfigError` with place, reason and value for ends in the wrong order, a list that is
  /// empty, a normal that has less than 1 % between min and max.
  explicit Distribution(const YamlValue& value);

  const YamlValue& value() const { return value_; }
  std::vector<YamlValue> choices() const;  // only `one_of` has some

  /// Draws a value. Equal keys give equal values; numbers have 12 significant digits.
  Value draw(const RngKey& key) const;
  /// The middle: median, or the first choice.
  Value middle() const;
  /// Both ends (a normal without min or max: 5 sigma from its mean), or all choices.
  std::vector<Value> ends() const;

 private:
  enum class Kind { uniform, time, log_uniform, normal, integers, one_of };

  std::string scalar(double x) const;
  Value at(double share) const;  // the value that this share of draws is below

  YamlValue value_;
  std::string name_;
  Kind kind_ = Kind::uniform;
  double least_ = 0.0, most_ = 0.0;  // times are seconds after `from_`
  double mean_ = 0.0, sigma_ = 0.0;
  std::string from_;
  std::size_t count_ = 0;  // number of choices
};

/// Throws `ConfigError` with the place of the first distribution in a file, if there is one, and
/// the reason; and for what is a distribution but for a misspelt name.
void refuse_distributions(const YamlValue& root, const std::string& reason);

}  // namespace dmise
