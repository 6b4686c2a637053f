#pragma once
#include <string>
#include <variant>
#include <vector>

#include "core/config/objects/earth_config.h"
#include "core/config/objects/flight_config.h"
#include "core/config/objects/proximity_config.h"
#include "core/orbit/elements/elements.h"
#include "core/orbit/motion.h"
#include "core/time/julian_date.h"

namespace dmise {

class YamlValue;
struct Section;

/// Motion of an object of the scenario: an element set for SGP4, or another model. What flies by
/// numerical integration or near another object is a `Trajectory` once the scenario is read.
struct MotionConfig {
  std::variant<MotionModel, MeanElements> model;
  std::string trajectory_path;  // an OEM, SP3 or track, resolved; empty for other models
  std::string satellite = {};   // its name in the SP3
  std::string node_where = {};  // place of the key `node`, for messages; empty for other models
  std::vector<std::string> warnings = {};         // see `unusual_orbit_values`
  std::optional<FlightConfig> flight = {};        // integrated; see core/config/fly_objects.h
  std::optional<ProximityConfig> proximity = {};  // near another; see core/config/place_deputies.h
};

/// Reads one of `two_body`, `numerical`, `oem`, `sp3`, `fixed`, `track`, `enu`, `sgp4`, `node`,
/// `proximity` of the object `name`, and its forces and manoeuvres; `start` is the default epoch of
/// two_body and time 0 of a track and of `enu`. Throws `ConfigError` `file:line:column: key:
/// reason`, for a file with its own line.
MotionConfig read_motion(const YamlValue& value, const Utc& start, const std::string& name,
                         const EarthConfig& earth = {});

/// The keys of `motion`.
const Section& motion_section();

}  // namespace dmise
