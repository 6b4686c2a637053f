#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/materials/material.h"

namespace dmise {

class YamlValue;
struct Section;

/// Materials by name, from a file in the format of launch/materials/library.yaml.
class MaterialLibrary {
 public:
  MaterialLibrary() = default;
  /// Throws `ConfigError` with `file:line:column`, also for a material that violates energy
  /// conservation.
  explicit MaterialLibrary(const std::string& path);

  /// The installed library; read once.
  static const MaterialLibrary& shipped();

  std::optional<Material> find(std::string_view name) const;
  /// Returns the material that `value` names. Throws `ConfigError` at `value` with the nearest
  /// name.
  Material require(const YamlValue& value) const;
  const std::map<std::string, Material, std::less<>>& all() const { return materials_; }

 private:
  std::map<std::string, Material, std::less<>> materials_;
};

/// Reads one material from its mapping.
Material read_material(const std::string& name, const YamlValue& value);

/// The keys of a file of materials.
const Section& material_library_section();

}  // namespace dmise
