#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/config/objects/attitude_config.h"
#include "core/config/objects/geometry_config.h"
#include "core/config/objects/motion_config.h"
#include "core/config/objects/object_model_config.h"
#include "core/config/objects/panel_config.h"
#include "core/config/yaml/section.h"
#include "core/orbit/breakup/breakup.h"
#include "core/orbit/debris/debris_population.h"
#include "core/orbit/sgp4/walker.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/reentry_light.h"
#include "core/time/julian_date.h"

namespace dmise {

class YamlValue;

/// A catalogue of element sets, `{catalogue: demo}`, a constellation, `{walker: {..}}` or `{train:
/// {..}}`, the pieces of an object, `{breakup: {..}}`, or debris, `{population: {..}}`.
struct ObjectSource {
  std::string path;                            // resolved; empty for those that are made
  std::string named;                           // as in the scenario: "demo" or a path; its name
  std::optional<Walker> walker;                // the constellation
  std::optional<Breakup> breakup;              // whose pieces they are; `sphere` has their albedo
  std::optional<DebrisPopulation> population;  // whose objects they are, likewise
  DiffuseSphere sphere;                        // for objects of which no facts are known
  std::string facts_path;               // CSV of brightness facts by catalogue number, may be empty
  std::vector<std::string> only;        // catalogue numbers or names; empty: all
  std::string where;                    // `file:line:column: objects[0].catalogue`, for messages
  std::vector<std::string> only_where;  // `file:line:column: key` of each name
  ObjectModels models;                  // rules for the objects of all catalogues of the scenario
};

/// An object of the scenario: `{name: inspector, motion: {..}, attitude: nadir}`.
struct OwnObject {
  std::string name;
  std::string where;                   // `file:line:column: objects[2]`, for messages
  std::uint32_t catalogue_number = 0;  // 0: assigned, see `first_own_number`
  MotionConfig motion;
  std::optional<AttitudeConfig> attitude;
  std::optional<HingedPanel> panel;  // how the geometry's panel turns, if it has one
  std::optional<GeometryConfig> geometry;
  DiffuseSphere sphere;         // without a geometry
  std::string model_path = {};  // the model that gave attitude, panel and geometry; may be empty
  std::optional<Glints> glints = {};         // taken from that model
  std::optional<ReentryLight> reentry = {};  // without a geometry
};

/// How a node of the user's moves or turns an object; null: none does.
inline const NodeMotion* motion_by_node(const OwnObject& object) {
  const auto* model = std::get_if<MotionModel>(&object.motion.model);
  return model ? std::get_if<NodeMotion>(model) : nullptr;
}
inline const NodeAttitude* attitude_by_node(const OwnObject& object) {
  return object.attitude ? std::get_if<NodeAttitude>(&object.attitude->model) : nullptr;
}

/// First catalogue number assigned to objects without one, in the scenario's order, and then to
/// satellites of constellations, fragments and debris: products identify objects by number, and
/// catalogues stay below.
inline constexpr std::uint32_t first_own_number = 990'000'001;

/// The models of the scenario's objects of catalogues: those of the catalogue that states them.
const ObjectModels& models_of(const std::vector<ObjectSource>& catalogues);

/// Whether objects have a shape.
bool have_shapes(const std::vector<ObjectSource>& catalogues, const std::vector<OwnObject>& own);
/// Whether objects have small parts that glint.
bool have_glints(const std::vector<ObjectSource>& catalogues, const std::vector<OwnObject>& own);

struct ObjectsConfig {
  std::vector<ObjectSource> catalogues;
  std::vector<OwnObject> own;
};

/// Reads `objects:`, a list of all kinds. Throws `ConfigError` `file:line:column: key: reason`.
ObjectsConfig read_objects(const YamlValue& value, const Utc& start, const EarthConfig& earth = {});

class JsonWriter;
/// Writes the part that determines the products, without the content of files.
void write_objects(JsonWriter& json, const std::vector<ObjectSource>& catalogues,
                   const std::vector<OwnObject>& own);

/// Returns all files that they name, in order; an empty path for an optional file that is not
/// given.
std::vector<std::string> files_of(const std::vector<ObjectSource>& catalogues,
                                  const std::vector<OwnObject>& own);

/// The forms of `objects`.
Forms objects_forms();

}  // namespace dmise
