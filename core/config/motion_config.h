#pragma once
#include <string>
#include <variant>
#include <vector>

#include "core/config/earth_config.h"
#include "core/orbit/elements.h"
#include "core/orbit/motion.h"
#include "core/time/julian_date.h"

namespace dmise {

class YamlValue;
struct Section;

/// Motion of an object of the scenario: an element set for SGP4, or another model.
struct MotionConfig {
  std::variant<MotionModel, MeanElements> model;
  std::string trajectory_path;             // of an OEM or a track, resolved; empty for other models
  std::string node_where = {};             // of `node`, for messages; empty for other models
  std::vector<std::string> warnings = {};  // see `unusual_orbit_values`
};

/// Reads one of `two_body`, `oem`, `fixed`, `track`, `enu`, `sgp4`, `node` of the object `name`;
/// `start` is the default epoch of two_body and time 0 of a track and of `enu`. Throws
/// `ConfigError` `file:line:column: key: reason`, for a file with its own line.
MotionConfig read_motion(const YamlValue& value, const Utc& start, const std::string& name,
                         const EarthConfig& earth = {});

/// The keys of `motion`.
const Section& motion_section();

}  // namespace dmise
