#pragma once
#include <string>

#include "core/config/section.h"
#include "core/orbit/attitude.h"

namespace dmise {

class YamlValue;

struct AttitudeConfig {
  Attitude model;
  std::string table_path;       // resolved; empty for other models
  std::string node_where = {};  // of `node`, for messages; empty for other models
};

/// Reads `nadir`, `sun_tracking`, or one of `{inertial: ..}`, `{spinning: ..}`, `{table: FILE}`,
/// `{node: NAME}`.
/// Throws `ConfigError` `file:line:column: key: reason`.
AttitudeConfig read_attitude(const YamlValue& value);

/// The forms of `attitude`.
Forms attitude_forms();

}  // namespace dmise
