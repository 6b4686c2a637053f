#pragma once
#include "core/config/scenario.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads `fusion:` of a scenario. Throws `ConfigError`.
FusionConfig read_fusion(const YamlValue& value);

/// The keys of `fusion`.
const Section& fusion_section();

}  // namespace dmise
