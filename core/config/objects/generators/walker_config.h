#pragma once
#include "core/config/yaml/section.h"
#include "core/orbit/sgp4/walker.h"

namespace dmise {

class YamlValue;

/// Names of satellites are within 64 characters.
inline constexpr std::size_t longest_constellation_name_bytes = 48;

/// Reads the mapping `walker`; `start` is the default epoch. Name and numbers are the caller's.
/// Throws `ConfigError` `file:line:column: key: reason`.
Walker read_walker(const YamlValue& value, const Utc& start);

/// Reads the mapping `train` likewise.
Walker read_train(const YamlValue& value, const Utc& start);

/// The keys of `walker` and of `train`.
const Section& walker_section();
const Section& train_section();

}  // namespace dmise
