#pragma once
#include <string>

#include "core/config/yaml_reader.h"
#include "core/orbit/attitude.h"

namespace dmise {

struct AttitudeConfig {
  Attitude model;
  std::string table_path;  // resolved; empty for other models
};

/// Reads `nadir`, `sun_tracking`, or one of `{inertial: ..}`, `{spinning: ..}`, `{table: FILE}`.
/// Throws `ConfigError` `file:line:column: key: reason`.
AttitudeConfig read_attitude(const YamlValue& value);

/// The forms of `attitude`.
Forms attitude_forms();

}  // namespace dmise
