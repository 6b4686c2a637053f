#pragma once
#include <memory>
#include <string>

#include "core/sky/stars/star_map.h"

namespace dmise {

/// Loads the catalogue of stars of that name, or a file, through the user's cache, once in this
/// process (`share_star_map`); null for "none", the default for "". Throws `ConfigError`, which
/// begins with `option` if a named one is missing.
std::shared_ptr<const StarMap> load_star_catalogue(const std::string& name,
                                                   const std::string& option = "--catalogue");

}  // namespace dmise
