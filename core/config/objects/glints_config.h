#pragma once
#include "core/facets/glints.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads `{lobe_deg: [narrowest, widest], parts_in_view: n, share: [narrowest, widest]}`. Throws
/// `ConfigError` for shares of more than all light.
Glints read_glints(const YamlValue& value);

/// The keys of `glints`.
const Section& glints_section();

}  // namespace dmise
