#pragma once
#include "core/config/scenario.h"
#include "core/orbit/elements/elements.h"

namespace dmise {

class JsonWriter;
class YamlValue;
struct Section;

/// Reads `fusion:` of a scenario. Throws `ConfigError`.
FusionConfig read_fusion(const YamlValue& value);

/// The element sets of `catalogue` that are old enough at the start of a run: of each object the
/// newest. Throws `ConfigError` if there are none.
std::vector<MeanElements> believed_elements(const FusionConfig& config, const Utc& start);

/// Writes the part that determines the products.
void write_fusion(JsonWriter& json, const FusionConfig& fusion);

/// The keys of `fusion`.
const Section& fusion_section();

}  // namespace dmise
