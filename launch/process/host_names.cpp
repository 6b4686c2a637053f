#include "launch/process/host_names.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "nodes/runtime/security/keys.h"

namespace dmise {

std::string agent_name(const Scenario& scenario, int host) {
  std::string name = "host-" + std::to_string(host + 1);
  const auto taken = [&](const auto& sensor) { return sensor.name == name; };
  while (std::any_of(scenario.sensors.begin(), scenario.sensors.end(), taken)) name += "-agent";
  return name;
}

std::vector<std::string> sensors_on(const Scenario& scenario, int host, int hosts) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i)
    if (host_of(i, hosts) == host) names.push_back(scenario.sensors[i].name);
  if (names.empty())
    throw ConfigError("--hosts: " + std::to_string(hosts) + " agents, but " +
                      counted(scenario.sensors.size(), "sensor"));
  return names;
}

namespace {

std::string public_key_of_agent(const std::string& keys, const std::string& agent, int hosts) try {
  return public_key_of(keys, agent);
} catch (const ConfigError& error) {
  throw ConfigError(std::string(error.what()) + "; dmise keygen --scenario --hosts " +
                    std::to_string(hosts) + " makes it");
}

}  // namespace

void check_agent_keys(const Scenario& scenario, int hosts, const std::string& keys) {
  const auto allowed = read_allowed(keys);
  for (int host = 0; host < hosts; ++host) {
    const std::string agent = agent_name(scenario, host);
    const std::string key = public_key_of_agent(keys, agent, hosts);
    for (const auto& sensor : sensors_on(scenario, host, hosts))
      if (!allowed.at(key).nodes.contains(sensor))
        throw ConfigError(keys + ": the key of " + agent + " may not speak for " + sensor +
                          "; dmise keygen --scenario --hosts " + std::to_string(hosts) +
                          " makes keys that may");
  }
}

}  // namespace dmise
