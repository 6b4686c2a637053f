#pragma once
#include "core/config/scenario.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads `output:` of a scenario. Throws `ConfigError`.
OutputConfig read_output(const YamlValue& value);

/// The keys of `output`.
const Section& output_section();

}  // namespace dmise
