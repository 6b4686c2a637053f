#include "core/config/scenario_draws.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/config/schema.h"
#include "core/config/yaml/yaml_limits.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

/// Calls `change(value, key)` for each distribution within `value`, in the order of the file, until
/// it is none. `key` is the path, and for a distribution that another chose "path/1".
template <class Change>
void for_distributions(YamlValue value, const Change& change) {
  for (int level = 0; Distribution::is(value.node()); ++level)
    change(value, value.path() + (level > 0 ? "/" + std::to_string(level) : ""));
  if (value.is_map()) {
    YamlMap map(value);
    for (const auto& key : map.keys()) for_distributions(map.require(key), change);
  } else if (value.is_list()) {
    for (const auto& item : value.list()) for_distributions(item, change);
  }
}

bool is_number(const YamlValue& value) {
  try {
    value.number();
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

/// Whether readers take a number at a path such as "sensors[0].exposure_s", of values with `forms`.
bool takes_number(std::string_view path, const Forms& forms) {
  if (path.starts_with('.')) path.remove_prefix(1);
  return std::ranges::any_of(forms, [path](const Form& form) {
    if (path.empty()) return form.kind == Form::Kind::number || form.kind == Form::Kind::integer;
    if (path.starts_with('['))
      return form.kind == Form::Kind::list &&
             takes_number(path.substr(path.find(']') + 1), form.items);
    if (form.kind != Form::Kind::map || !form.section) return false;
    const std::size_t end = std::min(path.find_first_of(".["), path.size());
    const Key* key = form.section().find(path.substr(0, end));
    return key && takes_number(path.substr(end), key->forms);
  });
}

/// Checks the form of every distribution, also of those in choices that are not taken.
void check_forms(const YamlValue& value) {
  Distribution::refuse_misspelt(value);
  if (Distribution::is(value.node())) {
    for (const auto& choice : Distribution(value).choices()) check_forms(choice);
  } else if (value.is_map()) {
    YamlMap map(value);
    for (const auto& key : map.keys()) check_forms(map.require(key));
  } else if (value.is_list()) {
    for (const auto& item : value.list()) check_forms(item);
  }
}

}  // namespace

ScenarioDraws::ScenarioDraws(const std::string& path)
    : ScenarioDraws(read_text_file(path, YamlLimits{}.bytes), path) {}

ScenarioDraws::ScenarioDraws(std::string text, std::string path)
    : path_(std::move(path)), text_(std::move(text)) {
  check_forms(root());
}

YamlValue ScenarioDraws::root() const { return YamlValue::parse(text_, path_); }

YamlValue ScenarioDraws::resolved(const Choose& choose, std::vector<DrawnValue>* drawn) const {
  const YamlValue tree = root();
  for_distributions(tree, [&](YamlValue& value, const std::string& key) {
    const Distribution distribution(value);
    const Distribution::Value taken = choose(distribution, key);
    if (taken.choice < 0) {
      value.become(taken.scalar);
    } else {
      value.become(distribution.choices()[std::size_t(taken.choice)]);
    }
    if (!drawn) return;
    if (value.is_scalar())
      drawn->push_back(
          {value.path(), value.node().Scalar(),
           is_number(value) &&
               (taken.choice < 0 || takes_number(value.path(), form::map(scenario_section)))});
    else
      drawn->push_back({value.path() + ".one_of" + key.substr(value.path().size()),
                        std::to_string(taken.choice), true});
  });
  return tree;
}

DrawnScenario ScenarioDraws::draw(std::uint64_t seed) const {
  DrawnScenario result;
  try {
    const YamlValue tree = resolved(
        [seed](const Distribution& from, const std::string& key) {
          return from.draw(rng_key(seed, "dataset", 0, key));
        },
        &result.drawn);
    result.scenario = read_scenario(tree);
  } catch (const ConfigError& e) {
    throw ConfigError(std::string(e.what()) + " (as drawn for seed " + std::to_string(seed) + ")");
  }
  result.scenario.seed = seed;
  return result;
}

void ScenarioDraws::check_ends(const Visit& visit) const { check_with({}, {}, visit); }

void ScenarioDraws::check_with(const std::vector<Fixed>& fixed, std::set<std::string> known,
                               const Visit& visit) const {
  std::vector<std::pair<std::string, Distribution>> met;  // for the first time
  const YamlValue tree = resolved([&](const Distribution& from, const std::string& key) {
    if (known.insert(from.value().where() + " " + key).second) met.emplace_back(key, from);
    for (const Fixed& f : fixed)
      if (f.key == key) return f.value;
    return from.middle();
  });
  try {
    const Scenario scenario = read_scenario(tree);
    if (visit) visit(scenario);
  } catch (const ConfigError& e) {
    const std::string which = !fixed.empty() ? " (" + fixed.back().value.what + ")"
                              : met.empty()  ? ""
                                             : " (each distribution in its middle)";
    throw ConfigError(e.what() + which);
  }
  for (const auto& [key, distribution] : met)
    for (const auto& end : distribution.ends()) {
      auto next = fixed;
      next.push_back({key, end});
      check_with(next, known, visit);
    }
}

}  // namespace dmise
