#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/materials/material.h"

namespace dmise {

/// Returns a material of the library by its name; empty if there is none.
using MaterialByName = std::function<std::optional<Material>(std::string_view)>;

/// Parses the materials of a Wavefront MTL file. Colours (Kd, Ks, Ns) become Phong's model,
/// tabulated at 450, 550 and 610 nm; a material that violates energy conservation is scaled down,
/// with a note. Extensions: `brdf NAME` takes a material of the library, `temperature_k` and
/// `thermal_emissivity` set its emission. `map_Kd` and `map_Bump` are described in the material,
/// but no file is opened. Other maps are ignored, with a note. Throws `ConfigError` with
/// `file:line`.
std::map<std::string, Material> parse_mtl(std::string_view text, const std::string& file,
                                          const MaterialByName& library,
                                          std::vector<std::string>& notes);

}  // namespace dmise
