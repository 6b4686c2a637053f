#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/materials/panel.h"

namespace dmise {

class YamlValue;
struct Section;

/// Shape of an object: `geometry: {model: box-wing, body: kapton, ..}` or `{obj: FILE}`.
struct GeometryConfig {
  std::shared_ptr<const Mesh> mesh;
  HingedPanel panel;               // how its panel turns, if it has one, unless told otherwise
  std::string obj_path;            // resolved; empty for a model
  std::string materials_path;      // the material library, resolved
  std::vector<std::string> notes;  // what was ignored or repaired in an OBJ, one line each
  std::string digest;              // hash of the mesh and its materials
};

/// Reads the mapping; docs/models/materials.md lists the keys. An OBJ has a panel only
/// `with_panel`; so does the digest. Throws `ConfigError`, for an OBJ with its own file and line.
GeometryConfig read_geometry(const YamlValue& value, bool with_panel = false);

/// The keys of `geometry`.
const Section& geometry_section();

}  // namespace dmise
