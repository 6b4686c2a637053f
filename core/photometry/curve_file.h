#pragma once
#include <string>
#include <string_view>

#include "core/photometry/curve.h"

namespace dmise {

/// Parses a curve from text: two columns or more, separated by commas or blanks, `#` for comments.
/// The first line names them: `wavelength_nm` (or _um, _m, _angstrom) first, then the value; a name
/// that ends in `_percent` is scaled to [0, 1]. Further columns are ignored. Throws `ConfigError`
/// with `name:line: reason`; wavelengths must ascend and values lie in [0, 1].
Curve parse_curve(std::string_view text, const std::string& name);

}  // namespace dmise
