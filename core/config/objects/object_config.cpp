#include "core/config/objects/object_config.h"

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/config/objects/breakup_config.h"
#include "core/config/objects/generators/population_config.h"
#include "core/config/objects/generators/walker_config.h"
#include "core/config/objects/reentry_config.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

constexpr std::size_t longest_name_bytes = 64;
constexpr std::uint32_t greatest_number = 999'999'999;

std::vector<Key> sphere_keys() {
  return {bound<&DiffuseSphere::radius_m>(
              "radius_m", form::above(0.0, 1000.0),
              "Radius of the diffuse sphere that is seen without a shape [m]."),
          bound<&DiffuseSphere::albedo>("albedo", form::above(0.0, 1.0), "Its albedo.")};
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

const Section& constellation_section() {
  static const Section section{
      "constellation", "Satellites of a constellation, or of one launch. `walker` or `train`.",
      with_keys({optional("walker", form::map(walker_section), "Its planes and satellites."),
                 optional("train", form::map(train_section), "Satellites behind each other."),
                 optional("name", form::text(),
                          "Unique, of 1 to 48 characters; its satellites are NAME-PLANE-PLACE, "
                          "of a train NAME-PLACE.",
                          "`walker` or `train`"),
                 optional("models", object_models_forms(),
                          "Models of families of objects, as of a catalogue.")},
                sphere_keys())};
  return section;
}

const Section& fragments_section() {
  static const Section section{
      "fragments",
      "Pieces of an object that has broken up.",
      {required("breakup", form::map(breakup_section), "What broke, when and how."),
       optional("name", form::text(),
                "Unique, of 1 to 48 characters; the fragments are NAME-NUMBER, the longest first.",
                "breakup"),
       optional("albedo", form::above(0.0, 1.0), "Albedo of the spheres that they are.",
                shortest_text(fragment_albedo))}};
  return section;
}

const Section& debris_section() {
  static const Section section{
      "debris",
      "Debris that no catalogue has, by its flux.",
      {required("population", form::map(population_section), "Sizes, heights and number."),
       optional("name", form::text(),
                "Unique, of 1 to 48 characters; the objects are NAME-NUMBER, the largest first.",
                "population"),
       optional("albedo", form::above(0.0, 1.0), "Albedo of the spheres that they are.",
                shortest_text(fragment_albedo))}};
  return section;
}

const Section& own_section() {
  static const Section section{
      "object", "An object of the scenario's own.",
      with_keys(
          {required("name", form::text(), "A unique name of 1 to 64 characters."),
           optional("catalogue_number", form::integer(1, greatest_number),
                    "Replaces the catalogue's object of this number. By default that of its "
                    "element set, else 990000001 and onwards."),
           required("motion", form::map(motion_section), "How it moves."),
           optional("attitude", attitude_forms(),
                    "How it is turned: towards the Earth, the Sun, or as given."),
           optional("panel", form::map(panel_section),
                    "The panel of its geometry that faces the Sun."),
           optional("geometry", form::map(geometry_section), "Its shape; needs an attitude."),
           optional("reentry", form::map(reentry_section),
                    "Light of its own by height, as it burns in the air; without a geometry."),
           optional("model", form::text(),
                    "A shipped model (`dmise list models`) or a file of one, in place of geometry "
                    "and panel. Its attitude holds unless the object has one.")},
          sphere_keys())};
  return section;
}

DiffuseSphere read_sphere(YamlMap& map) {
  DiffuseSphere sphere;
  read_bound(map, sphere);
  return sphere;
}

ObjectSource read_object_source(const YamlValue& value, const Utc&) {
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

void check_name(const ObjectSource& source, const std::optional<YamlValue>& name) {
  if (source.named.empty() || source.named.size() > longest_constellation_name_bytes)
    name->fail("must have 1 to 48 characters");
}

/// All but the state of the parent.
ObjectSource read_fragments(const YamlValue& value, const Utc& start) {
  YamlMap map(value, fragments_section());
  ObjectSource source;
  const auto breakup = map.require("breakup");
  const auto name = map.find("name");
  source.where = breakup.place();
  source.breakup = read_breakup(breakup, start);
  source.named = name ? printable(name->text()) : "breakup";
  check_name(source, name);
  source.breakup->name = source.named;
  source.sphere.albedo = map.number("albedo");
  map.done();
  return source;
}

ObjectSource read_debris(const YamlValue& value, const Utc& start) {
  YamlMap map(value, debris_section());
  ObjectSource source;
  const auto population = map.require("population");
  const auto name = map.find("name");
  source.where = population.place();
  source.population = read_population(population, start);
  source.named = name ? printable(name->text()) : "population";
  check_name(source, name);
  source.population->name = source.named;
  source.sphere.albedo = map.number("albedo");
  map.done();
  return source;
}

ObjectSource read_constellation(const YamlValue& value, const Utc& start) {
  YamlMap map(value, constellation_section());
  ObjectSource source;
  const auto walker = map.find("walker"), train = map.find("train"), name = map.find("name");
  if (walker && train) train->fail("goes without walker", false);
  source.where = (walker ? walker : train)->place();
  source.walker = walker ? read_walker(*walker, start) : read_train(*train, start);
  source.named = name ? printable(name->text()) : walker ? "walker" : "train";
  check_name(source, name);
  source.walker->name = source.named;
  source.sphere = read_sphere(map);
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
    object.glints = known->glints;
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
  if (const auto reentry = map.find("reentry")) {
    if (object.geometry) reentry->fail("goes without a shape", false);
    object.reentry = read_reentry(*reentry);
  }
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

bool have_glints(const std::vector<ObjectSource>& catalogues, const std::vector<OwnObject>& own) {
  return std::ranges::any_of(models_of(catalogues).rules(),
                             [](const auto& rule) { return rule.model->glints.has_value(); }) ||
         std::ranges::any_of(own, [](const OwnObject& o) { return o.glints.has_value(); });
}

Forms objects_forms() {
  return form::list(form::map(source_section) | form::map(constellation_section) |
                    form::map(fragments_section) | form::map(debris_section) |
                    form::map(own_section));
}

namespace {

/// Numbers own objects without a number, then satellites and fragments: in the scenario's order,
/// beyond those that are taken.
void assign_numbers(ObjectsConfig& objects, std::set<std::uint32_t>& taken) {
  std::uint32_t next = first_own_number;
  for (auto& object : objects.own)
    while (object.catalogue_number == 0)
      if (taken.insert(next++).second) object.catalogue_number = next - 1;
  if (!taken.empty()) next = std::max(first_own_number, *taken.rbegin() + 1);
  for (auto& source : objects.catalogues) {
    const auto number = [&](auto& made, int count) {
      made.first_number = next;
      next += std::uint32_t(count);
    };
    if (source.walker) number(*source.walker, source.walker->satellites());
    if (source.breakup) number(*source.breakup, source.breakup->fragment_count());
    if (source.population) number(*source.population, source.population->numbers());
    if (next > greatest_number)
      throw ConfigError(source.where + ": no catalogue numbers are left for its " +
                        (source.walker    ? "satellites"
                         : source.breakup ? "fragments"
                                          : "objects"));
  }
}

using ReadSource = ObjectSource (*)(const YamlValue&, const Utc&);

/// The reader of an entry that states many objects; null: it states one.
ReadSource kind_of_source(YamlMap& map) {
  static constexpr std::pair<const char*, ReadSource> kinds[] = {{"walker", read_constellation},
                                                                 {"train", read_constellation},
                                                                 {"breakup", read_fragments},
                                                                 {"population", read_debris},
                                                                 {"catalogue", read_object_source}};
  for (const auto& [key, read] : kinds)
    if (map.find(key)) return read;
  return nullptr;
}

/// Parents of breakups, which may be listed after them.
void read_parents(const YamlValue& list, const Utc& start, const EarthConfig& earth,
                  ObjectsConfig& objects) {
  std::size_t next = 0;
  for (const auto& entry : list.list()) {
    YamlMap map(entry);
    if (!kind_of_source(map)) continue;
    ObjectSource& source = objects.catalogues[next++];
    if (source.breakup) read_parent(map.require("breakup"), start, earth, objects, *source.breakup);
  }
}

}  // namespace

ObjectsConfig read_objects(const YamlValue& value, const Utc& start, const EarthConfig& earth) {
  ObjectsConfig objects;
  std::set<std::string> names, constellations;
  std::set<std::uint32_t> numbers;
  for (const auto& entry : value.list()) {
    YamlMap map(entry);
    if (const ReadSource read = kind_of_source(map)) {
      const bool stated = !models_of(objects.catalogues).empty();
      objects.catalogues.push_back(read(entry, start));
      const ObjectSource& source = objects.catalogues.back();
      if (stated && !source.models.empty())
        map.require("models").fail("another catalogue states models, which are of all", false);
      if (source.path.empty() && !constellations.insert(source.named).second)
        entry.fail("another constellation, breakup or population has the name " + source.named,
                   false);
      continue;
    }
    if (!map.find("name") && !map.find("motion"))
      entry.fail(
          "needs a catalogue, a walker, a train, a breakup, a population, or a name and a motion",
          false);
    objects.own.push_back(read_own_object(entry, start, earth));
    const OwnObject& object = objects.own.back();
    if (!names.insert(object.name).second) map.require("name").fail("another object has this name");
    if (object.catalogue_number != 0 && !numbers.insert(object.catalogue_number).second)
      entry.fail("another object has the number " + std::to_string(object.catalogue_number), false);
  }
  assign_numbers(objects, numbers);
  read_parents(value, start, earth, objects);
  return objects;
}

}  // namespace dmise
