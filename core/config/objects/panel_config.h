#pragma once
#include "core/config/objects/geometry_config.h"
#include "core/materials/panel.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads `{hinge: [x, y, z], normal: [x, y, z], hinge_m: [x, y, z]}` in body axes. Without a
/// geometry (null) the panel is one of which others are told. Throws `ConfigError` for a geometry
/// without a panel.
HingedPanel read_panel(const YamlValue& value, const GeometryConfig* geometry);

/// The keys of `panel`.
const Section& panel_section();

}  // namespace dmise
