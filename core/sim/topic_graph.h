#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/schedule.h"

namespace dmise {

/// Topics that a node publishes and consumes.
struct NodeTopics {
  std::string name;
  std::vector<std::string> produces;
  std::vector<std::string> consumes;
  Tick look_back = 0;  // ticks before the one it resumes at whose inputs it needs
  Schedule schedule;
  std::map<std::string, Tick> delays = {};  // consumed topics that it hears late, >= 1

  Tick delay(const std::string& topic) const {
    const auto found = delays.find(topic);
    return found == delays.end() ? 0 : found->second;
  }
};

/// Returns why these nodes cannot run together: a topic without a producer or with two, or a
/// dependency cycle within a tick, in which a topic with a delay does not count. Empty if they can.
std::optional<std::string> topic_fault(const std::vector<NodeTopics>& nodes);

/// Returns, by name, for nodes that can run together, how many ticks before tick k a node must have
/// published so that all its dependants can resume at k: the longest sum along the graph of the
/// look-backs of its consumers. For a topic with a delay it is the delay.
std::map<std::string, Tick> history_ticks(const std::vector<NodeTopics>& nodes);

}  // namespace dmise
