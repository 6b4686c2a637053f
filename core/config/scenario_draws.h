#pragma once
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/config/yaml/distribution.h"

namespace dmise {

class YamlValue;

/// A value that was drawn for one seed.
struct DrawnValue {
  // "sensors[0].exposure_s"; with ".one_of" for the number of a choice, from 0; of a choice within
  // that choice with ".one_of/1".
  std::string path;
  std::string text;
  bool is_number = false;  // also by the key: a name of digits is none
};

/// A scenario for one seed.
struct DrawnScenario {
  Scenario scenario;
  std::vector<DrawnValue> drawn;  // as they stand in the file
};

/// A scenario with distributions in it. What is drawn depends on the seed and on the path of the
/// key alone; a value that an alias repeats is drawn once.
class ScenarioDraws {
 public:
  /// Reads a file. Throws `ConfigError` with the place of a distribution that is not well-formed.
  explicit ScenarioDraws(const std::string& path);
  /// Reads a text; `path` names it in messages, and other files are found beside it.
  ScenarioDraws(std::string text, std::string path);

  const std::string& text() const { return text_; }
  /// Draws all values and reads the scenario. Throws `ConfigError` "... (as drawn for seed N)".
  DrawnScenario draw(std::uint64_t seed) const;
  using Visit = std::function<void(const Scenario&)>;
  /// Reads the scenario with each distribution at its ends and the others in the middle, and calls
  /// `visit` with each: together they name all files that a draw can name. Throws `ConfigError`
  /// with the value that is refused and which end it is.
  void check_ends(const Visit& visit = {}) const;

 private:
  using Choose = std::function<Distribution::Value(const Distribution&, const std::string& key)>;

  struct Fixed {
    std::string key;
    Distribution::Value value;
  };

  YamlValue root() const;
  /// Distributions that are not `known` are new: in a choice that is taken now.
  void check_with(const std::vector<Fixed>& fixed, std::set<std::string> known,
                  const Visit& visit) const;
  YamlValue resolved(const Choose& choose, std::vector<DrawnValue>* drawn = nullptr) const;

  std::string path_, text_;
};

}  // namespace dmise
