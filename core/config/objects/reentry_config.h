#pragma once
#include "core/photometry/reentry_light.h"

namespace dmise {

class YamlValue;
struct Section;

/// Reads `{height_m: [..], magnitude: [..], range_m: 100.0e+3}`. Throws `ConfigError`
/// `file:line:column: key: reason`.
ReentryLight read_reentry(const YamlValue& value);

/// The keys of `reentry`.
const Section& reentry_section();

}  // namespace dmise
