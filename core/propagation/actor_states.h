#pragma once
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/config/objects/object_config.h"
#include "core/sim/message.h"

namespace dmise {

/// What nodes of the user's say of the objects that they move or turn, by node and tick.
class ActorStates {
 public:
  /// Takes the states of a message on an actor's topic; false for any other message.
  bool add(const Message& message);
  /// Null if the node has said nothing of the tick. Throws `Error` if its states are of fewer
  /// objects than `place`.
  const ObjectStates* of(const std::string& node, Tick tick, std::size_t place) const;
  void forget_before(Tick tick);

 private:
  std::map<std::string, std::map<Tick, std::shared_ptr<const ObjectStates>>> states_;
};

/// Topics of the nodes that move or turn any of these objects.
std::vector<std::string> actor_topics(std::span<const OwnObject> objects);

}  // namespace dmise
