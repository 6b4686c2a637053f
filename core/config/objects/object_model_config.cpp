#include "core/config/objects/object_model_config.h"

#include <fnmatch.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/config/objects/glints_config.h"
#include "core/config/objects/panel_config.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

constexpr const char* all_shipped = "shipped";

const Section& object_model_section() {
  static const Section section{
      "object model",
      "What the objects of a family look like.",
      {required("source", form::text(), "Where its numbers are from, and which are assumed."),
       optional("names", form::list(form::text()),
                "Patterns of names of the objects that `models: shipped` gives it."),
       required("attitude", attitude_forms(), "How the objects are turned; no table, no node."),
       optional("panel", form::map(panel_section), "The panel of the geometry."),
       required("geometry", form::map(geometry_section), "Shape and materials."),
       optional("glints", form::map(glints_section), "Small parts that glint and fade.")}};
  return section;
}

const Section& models_section() {
  static const Section section{
      "models",
      "Models of objects of catalogues, the first that fits.",
      {},
      Key{"^.+$", form::text(),
          "A shipped model (`dmise list models`) or a file of one, for the objects whose name or "
          "number fits the pattern: *, ? and [..] as of a shell."}};
  return section;
}

std::shared_ptr<const ObjectModel> read_model(const std::string& name, const YamlValue& file) {
  YamlMap map(file, object_model_section());
  auto model = std::make_shared<ObjectModel>();
  model->name = name;
  model->path = file.file();
  model->source = map.require("source").text();
  if (const auto names = map.find("names"))
    for (const auto& pattern : names->list()) model->names.push_back(pattern.text());
  const auto attitude = map.require("attitude"), geometry = map.require("geometry");
  model->attitude = read_attitude(attitude);
  if (!model->attitude.table_path.empty() || !model->attitude.node_where.empty())
    attitude.fail("must be nadir, sun_tracking, inertial, spinning or tumbling", false);
  const auto panel = map.find("panel");
  model->geometry = read_geometry(geometry, panel.has_value());
  if (panel) model->panel = read_panel(*panel, &model->geometry);
  if (const auto glints = map.find("glints")) model->glints = read_glints(*glints);
  map.done();
  return model;
}

std::vector<ObjectModels::Rule> shipped_rules() {
  std::vector<ObjectModels::Rule> rules;
  for (const auto& name : preset_names("models")) {
    const auto model = shipped_object_model(name);
    for (const auto& pattern : model->names) rules.push_back({pattern, model});
  }
  return rules;
}

bool fits(const std::string& pattern, const std::string& text) {
  return fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
}

}  // namespace

std::shared_ptr<const ObjectModel> read_object_model(const YamlValue& value) {
  return read_model(value.text(), load_preset("model", value));
}

std::shared_ptr<const ObjectModel> shipped_object_model(const std::string& name) {
  return read_object_model(
      YamlMap(YamlValue::parse("model: " + name, "launch/models")).require("model"));
}

const ObjectModel* ObjectModels::of(const std::string& name, std::uint32_t catalogue_number) const {
  if (rules_.empty()) return nullptr;
  const std::string number = std::to_string(catalogue_number);
  for (const auto& [pattern, model] : rules_)
    if (fits(pattern, name) || fits(pattern, number)) return model.get();
  return nullptr;
}

ObjectModels read_object_models(const YamlValue& value) {
  if (value.is_scalar()) {
    if (value.text() != all_shipped)
      value.fail("must be shipped, or a mapping of patterns to models");
    return ObjectModels(shipped_rules());
  }
  YamlMap map(value, models_section());
  std::vector<ObjectModels::Rule> rules;
  for (const auto& pattern : map.keys()) {
    const auto model = map.require(pattern);
    const auto known = std::find_if(rules.begin(), rules.end(), [&](const auto& rule) {
      return rule.model->name == model.text();
    });
    rules.push_back({pattern, known != rules.end() ? known->model : read_object_model(model)});
  }
  if (rules.empty()) value.fail("must name a model; without it all objects are spheres", false);
  return ObjectModels(std::move(rules));
}

Forms object_models_forms() { return form::text({all_shipped}) | form::map(models_section); }

}  // namespace dmise
