#include "nodes/environment/environment_actor.h"

namespace dmise {

std::vector<std::string> EnvironmentActor::produces() const {
  std::vector<std::string> topics{environment_topic};
  for (const auto& sensor : source_.ground_sensors()) topics.push_back(site_prefix + sensor.name);
  return topics;
}

std::vector<Message> EnvironmentActor::step(Tick tick, std::span<const Message>) {
  std::vector<Message> messages;
  if (tick % source_.common_period() == 0)
    messages.push_back({environment_topic, tick, std::make_shared<State>(source_.common(tick))});
  if (tick % source_.site_period() == 0)
    for (const auto& sensor : source_.ground_sensors())
      messages.push_back(
          {site_prefix + sensor.name, tick, std::make_shared<State>(source_.site(sensor, tick))});
  ++steps_;
  return messages;
}

}  // namespace dmise
