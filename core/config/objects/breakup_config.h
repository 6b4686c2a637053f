#pragma once
#include "core/config/objects/object_config.h"
#include "core/config/yaml/section.h"
#include "core/orbit/breakup/breakup.h"

namespace dmise {

class YamlValue;

/// Albedo of fragments whose scenario states none: Mulrooney et al. 2008, "Optical size versus
/// albedo", Orbital Debris Quarterly News 12(3).
inline constexpr double fragment_albedo = 0.175;

/// Reads the mapping `breakup`, all but the parent's state; `start` is that of the run and the
/// default time. Name and numbers are the caller's. Throws `ConfigError` `file:line:column: key:
/// reason`.
Breakup read_breakup(const YamlValue& value, const Utc& start);

/// Reads `parent` of the same mapping: a name or number among `objects`, of which catalogues are
/// read for it, or a motion. Sets the state. Throws likewise.
void read_parent(const YamlValue& value, const Utc& start, const EarthConfig& earth,
                 const ObjectsConfig& objects, Breakup& breakup);

/// The keys of `breakup`.
const Section& breakup_section();

}  // namespace dmise
