#include "core/config/object_config.h"

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/config/search_path.h"
#include "core/config/yaml_reader.h"

namespace dmise {
namespace {

constexpr std::size_t longest_name_bytes = 64;

std::vector<Key> sphere_keys() {
  return {optional("radius_m", form::above(0.0, 1000.0),
                   "Radius of the diffuse sphere that is seen without a shape [m].", "1"),
          optional("albedo", form::above(0.0, 1.0), "Its albedo.", "0.2")};
}

const Section& source_section() {
  static const Section section{
      "catalogue", "Objects of a catalogue.",
      with_keys(
          {required("catalogue", form::text({default_object_catalogue}),
                    "`demo` (979 objects of January 2018), or a file of TLE, 3LE, OMM or gpredict "
                    "element sets beside the scenario."),
           optional("facts", form::text(), "A CSV file of sizes and albedos of known objects."),
           optional("only", form::list(form::text()),
                    "Numbers or names of the objects to take; without it all are taken."),
           optional("models", object_models_forms(),
                    "Models of families of objects: `shipped`, by the names that each model has, "
                    "or patterns of names and numbers with their models. They are of the objects "
                    "of all catalogues; the others are diffuse spheres.")},
          sphere_keys())};
  return section;
}

const Section& own_section() {
  static const Section section{
      "object", "An object of the scenario's own.",
      with_keys(
          {required("name", form::text(), "A unique name of 1 to 64 characters."),
           optional("catalogue_number", form::integer(1, 999'999'999),
                    "Replaces the catalogue's object of this number. By default that of its "
                    "element set, else 990000001 and onwards."),
           required("motion", form::map(motion_section), "How it moves."),
           optional("attitude", attitude_forms(),
                    "How it is turned: towards the Earth, the Sun, or as given."),
           optional("panel", form::map(panel_section),
                    "The panel of its geometry that faces the Sun."),
           optional("geometry", form::map(geometry_section), "Its shape; needs an attitude."),
           optional("model", form::text(),
                    "A shipped model (`dmise list models`) or a file of one, in place of geometry "
                    "and panel. Its attitude holds unless the object has one.")},
          sphere_keys())};
  return section;
}

DiffuseSphere read_sphere(YamlMap& map) {
  const DiffuseSphere usual;
  return {.radius_m = map.number_or("radius_m", usual.radius_m),
          .albedo = map.number_or("albedo", usual.albedo)};
}

ObjectSource read_object_source(const YamlValue& value) {
  YamlMap map(value, source_section());
  ObjectSource source;
  const auto catalogue = map.require("catalogue");
  source.where = catalogue.place();
  source.named = catalogue.text();
  if (const char* file = object_catalogue_file(source.named)) {
    source.named = default_object_catalogue;
    source.path = find_catalogue(file);
    if (source.path.empty()) catalogue.fail(missing_catalogue(file));
  } else {
    source.path = catalogue.existing_file();
  }
  source.sphere = read_sphere(map);
  if (const auto facts = map.find("facts")) source.facts_path = facts->existing_file();
  if (const auto only = map.find("only")) {
    for (const auto& name : only->list()) {
      const std::string shown = printable(name.text());
      if (std::find(source.only.begin(), source.only.end(), shown) != source.only.end())
        name.fail("is named twice");
      source.only.push_back(shown);
      source.only_where.push_back(name.place());
    }
    if (source.only.empty()) only->fail("must name an object; without it all are taken", false);
  }
  if (const auto models = map.find("models")) source.models = read_object_models(*models);
  map.done();
  return source;
}

/// Reads what a model may give: attitude, panel, geometry.
void read_appearance(YamlMap& map, OwnObject& object) {
  if (const auto attitude = map.find("attitude")) object.attitude = read_attitude(*attitude);
  const auto panel = map.find("panel"), geometry = map.find("geometry"), model = map.find("model");
  if (model) {
    for (const auto& value : {panel, geometry})
      if (value) value->fail("the model has it", false);
    const auto known = read_object_model(*model);
    if (!object.attitude) object.attitude = known->attitude;
    object.geometry = known->geometry;
    object.panel = known->panel;
    object.model_path = known->path;
    return;
  }
  for (const auto& value : {panel, geometry})
    if (value && !object.attitude) value->fail("needs an attitude", false);
  if (geometry) object.geometry = read_geometry(*geometry, panel.has_value());
  if (panel) object.panel = read_panel(*panel, object.geometry ? &*object.geometry : nullptr);
}

OwnObject read_own_object(const YamlValue& value, const Utc& start, const EarthConfig& earth) {
  YamlMap map(value, own_section());
  OwnObject object;
  const auto name = map.require("name");
  object.where = name.place();
  object.name = printable(name.text());  // in the form that is displayed, published and searched
  if (object.name.empty() || object.name.size() > longest_name_bytes)
    name.fail("must have 1 to 64 characters");
  if (const auto number = map.find("catalogue_number"))
    object.catalogue_number = static_cast<std::uint32_t>(number->integer());
  object.motion = read_motion(map.require("motion"), start, object.name, earth);
  read_appearance(map, object);
  object.sphere = read_sphere(map);
  map.done();
  if (const auto* elements = std::get_if<MeanElements>(&object.motion.model))
    if (object.catalogue_number == 0) object.catalogue_number = elements->catalogue_number;
  return object;
}

}  // namespace

const ObjectModels& models_of(const std::vector<ObjectSource>& catalogues) {
  static const ObjectModels none;
  for (const auto& source : catalogues)
    if (!source.models.empty()) return source.models;
  return none;
}

bool have_shapes(const std::vector<ObjectSource>& catalogues, const std::vector<OwnObject>& own) {
  return !models_of(catalogues).empty() || std::ranges::any_of(own, [](const OwnObject& object) {
    return object.geometry.has_value();
  });
}

Forms objects_forms() { return form::list(form::map(source_section) | form::map(own_section)); }

ObjectsConfig read_objects(const YamlValue& value, const Utc& start, const EarthConfig& earth) {
  ObjectsConfig objects;
  std::set<std::string> names;
  std::set<std::uint32_t> numbers;
  for (const auto& entry : value.list()) {
    YamlMap map(entry);
    if (map.find("catalogue")) {
      const bool stated = !models_of(objects.catalogues).empty();
      objects.catalogues.push_back(read_object_source(entry));
      if (stated && !objects.catalogues.back().models.empty())
        map.require("models").fail("another catalogue states models, which are of all", false);
      continue;
    }
    if (!map.find("name") && !map.find("motion"))
      entry.fail("needs a catalogue, or a name and a motion", false);
    objects.own.push_back(read_own_object(entry, start, earth));
    const OwnObject& object = objects.own.back();
    if (!names.insert(object.name).second) map.require("name").fail("another object has this name");
    if (object.catalogue_number != 0 && !numbers.insert(object.catalogue_number).second)
      entry.fail("another object has the number " + std::to_string(object.catalogue_number), false);
  }
  std::uint32_t next = first_own_number;
  for (auto& object : objects.own)
    while (object.catalogue_number == 0)
      if (numbers.insert(next++).second) object.catalogue_number = next - 1;
  return objects;
}

}  // namespace dmise
