#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/sim/participant.h"

namespace dmise {

/// Publishes what a node has said in a recorded run of the same scenario (docs/clients.md, Record
/// and replay), in place of its program.
class RecordedActor : public Actor {
 public:
  /// `digest`: of the scenario. Throws `ConfigError` "PATH: reason" for a file that is not a whole
  /// recording of this node in a run of this scenario.
  RecordedActor(const Scenario& scenario, std::string node, const std::string& digest,
                const std::string& path);

  std::string name() const override { return node_; }
  std::vector<std::string> produces() const override { return {topic_}; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;

 private:
  /// Adds recorded states that are due.
  void add(std::shared_ptr<const State> state, const Scenario& scenario);

  std::string node_, topic_;
  std::vector<std::shared_ptr<const State>> states_;  // by tick
};

}  // namespace dmise
