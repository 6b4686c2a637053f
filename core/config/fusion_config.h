#pragma once
#include "core/config/scenario.h"
#include "core/config/yaml_reader.h"

namespace dmise {

/// Reads `fusion:` of a scenario. Throws `ConfigError`.
FusionConfig read_fusion(const YamlValue& value);

/// The keys of `fusion`.
const Section& fusion_section();

}  // namespace dmise
