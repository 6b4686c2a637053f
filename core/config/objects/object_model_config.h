#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/objects/attitude_config.h"
#include "core/config/objects/geometry_config.h"
#include "core/config/yaml/section.h"
#include "core/facets/glints.h"

namespace dmise {

class YamlValue;

/// What the objects of a family look like: shape, materials and attitude law. A file of
/// launch/models, or the user's own.
struct ObjectModel {
  std::string name, path;          // as named; resolved
  std::string source;              // where its numbers come from
  std::vector<std::string> names;  // patterns of the objects of catalogues that look so
  AttitudeConfig attitude;
  std::optional<HingedPanel> panel;
  GeometryConfig geometry;
  std::optional<Glints> glints;
};

/// Reads the file that `value` names, or the shipped model of this name. Throws `ConfigError`.
std::shared_ptr<const ObjectModel> read_object_model(const YamlValue& value);

/// The shipped model of a name. Throws `ConfigError` that names those there are.
std::shared_ptr<const ObjectModel> shipped_object_model(const std::string& name);

/// The models of a catalogue's objects, by name or number.
class ObjectModels {
 public:
  struct Rule {
    std::string pattern;  // matches names and numbers, with *, ? and [..] as in a shell
    std::shared_ptr<const ObjectModel> model;
  };

  ObjectModels() = default;
  explicit ObjectModels(std::vector<Rule> rules) : rules_(std::move(rules)) {}

  bool empty() const { return rules_.empty(); }
  const std::vector<Rule>& rules() const { return rules_; }
  /// The model of the first rule whose pattern is of the name or the number; null: none is.
  const ObjectModel* of(const std::string& name, std::uint32_t catalogue_number) const;

 private:
  std::vector<Rule> rules_;
};

/// Reads `shipped`, or a mapping of patterns to models.
ObjectModels read_object_models(const YamlValue& value);

/// The forms of `models` of a catalogue.
Forms object_models_forms();

}  // namespace dmise
