#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"

namespace dmise {

// Assignment of sensors to agents: round robin.

/// Index of the host of sensor `sensor` of a scenario, both from 0.
inline int host_of(std::size_t sensor, int hosts) { return int(sensor) % hosts; }

/// Name of the agent of `host` (from 0): "host-1", or longer if a sensor has that name.
std::string agent_name(const Scenario& scenario, int host);

/// The sensors on `host` of `hosts`. Throws `ConfigError` if there are none.
std::vector<std::string> sensors_on(const Scenario& scenario, int host, int hosts);

/// Throws `ConfigError` if an agent has no key in the directory `keys`, or one that may not speak
/// for each of its sensors.
void check_agent_keys(const Scenario& scenario, int hosts, const std::string& keys);

}  // namespace dmise
