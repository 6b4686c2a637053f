#pragma once
#include <string>
#include <string_view>

#include "core/sky/air/turbulence.h"

namespace dmise {

/// Parses a turbulence profile from CSV text with the header `height_m,cn2`; `#` for comments.
/// Throws `ConfigError` with `name:line: reason`: heights above the site must be >= 0 and ascend,
/// Cn2 must be > 0.
Cn2Table parse_cn2(std::string_view text, const std::string& name);

}  // namespace dmise
