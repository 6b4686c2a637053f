#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/materials/material.h"

namespace dmise {

/// A material of the library by its name.
using MaterialByName = std::function<std::optional<Material>(std::string_view)>;

/// Materials of a Wavefront MTL file by name. Colours (Kd, Ks, Ns) become Phong's model, tabulated
/// at 450, 550 and 610 nm; one that would reflect more than falls in is scaled down, with a note.
/// Beyond Wavefront: `brdf NAME` takes the material of the library, `temperature_k` and
/// `thermal_emissivity` what it emits. Of `map_Kd` and `map_Bump` the material gets what the line
/// says; no file is opened. Other maps are left out, with a note. Throws `ConfigError` with
/// `file:line`.
std::map<std::string, Material> parse_mtl(std::string_view text, const std::string& file,
                                          const MaterialByName& library,
                                          std::vector<std::string>& notes);

}  // namespace dmise
