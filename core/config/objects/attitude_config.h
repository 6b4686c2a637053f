#pragma once
#include <optional>
#include <string>

#include "core/config/yaml/section.h"
#include "core/orbit/attitude.h"

namespace dmise {

class YamlValue;

struct AttitudeConfig {
  Attitude model;
  std::string table_path;       // resolved; empty for other models
  std::string node_where = {};  // place of the key `node`, for messages; empty for other models
  std::string where = {};       // `file:line:column: objects[0].attitude`, for messages
};

/// Reads `nadir`, `sun_tracking`, or one of `{inertial: ..}`, `{spinning: ..}`, `{tumbling: ..}`,
/// `{table: FILE}`, `{node: NAME}`.
/// Throws `ConfigError` `file:line:column: key: reason`.
AttitudeConfig read_attitude(const YamlValue& value);

/// A warning that names the key if ticks are so long that the attitude between them is more than
/// 0.1 deg off.
std::optional<std::string> coarse_tick_warning(const AttitudeConfig& attitude, double tick_s);

/// The forms of `attitude`.
Forms attitude_forms();

}  // namespace dmise
