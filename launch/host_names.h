#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"

namespace dmise {

// Where sensors are that are put behind agents: in turn, the first behind the first.

/// Which of `hosts` the sensor `sensor` of a scenario is on, both from 0.
inline int host_of(std::size_t sensor, int hosts) { return int(sensor) % hosts; }

/// Name of the agent of `host` (from 0): "host-1", or longer where a sensor has that name.
std::string agent_name(const Scenario& scenario, int host);

/// The sensors on `host` of `hosts`. Throws `ConfigError` when there are none left for it.
std::vector<std::string> sensors_on(const Scenario& scenario, int host, int hosts);

/// Throws `ConfigError` when the key of an agent in the directory `keys` is not there, or may not
/// speak for each of its sensors.
void check_agent_keys(const Scenario& scenario, int hosts, const std::string& keys);

}  // namespace dmise
