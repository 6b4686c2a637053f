#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/config/yaml_reader.h"
#include "core/materials/mesh.h"

namespace dmise {

/// The shape of an object: `geometry: {model: box-wing, body: kapton, ..}` or `{obj: FILE}`.
struct GeometryConfig {
  std::shared_ptr<const Mesh> mesh;
  std::string obj_path;            // resolved; empty for a model
  std::string materials_path;      // of the library, resolved
  std::vector<std::string> notes;  // what reading an OBJ left out or put right, one line each
  std::string digest;              // of the mesh and its materials: equal light, equal digest
};

/// Reads it; docs/models/materials.md lists the keys. Throws `ConfigError`, of an OBJ with its own
/// file and line.
GeometryConfig read_geometry(const YamlValue& value);

}  // namespace dmise
