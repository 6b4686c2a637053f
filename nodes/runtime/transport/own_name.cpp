#include "nodes/runtime/transport/own_name.h"

#include "nodes/runtime/security/security.h"

namespace dmise {
namespace {

std::optional<std::string> fault_of_join(const v1::Join& join, zmq::message_t& frame,
                                         const std::string& who) {
  const std::string granted = "; dmise keygen --nodes makes keys that may";
  if (join.host().empty() && join.name() != who)
    return "the key of " + who + " is not that of " + join.name();
  if (join.agent() && !is_agent_key(frame))
    return "the key of " + who + " may not speak for nodes" + granted;
  if (join.host().empty()) return std::nullopt;
  if (join.host() != who) return "the key of " + who + " is not that of " + join.host();
  if (!may_speak_for(frame, join.name()))
    return "the key of " + who + " may not speak for " + join.name() + granted;
  return std::nullopt;
}

}  // namespace

std::optional<std::string> fault_of_sender(const v1::NodeMessage& message, zmq::message_t& frame,
                                           const std::string& connection) {
  const std::string who = sender_of(frame);
  if (message.has_join()) return fault_of_join(message.join(), frame, who);
  const bool own = message.has_hello()       ? true
                   : message.has_heartbeat() ? message.heartbeat().name() == who
                   : message.has_control()   ? who == operator_name
                                             : connection.empty() || connection == who;
  if (own) return std::nullopt;
  return message.has_control() ? who + " is not the operator"
                               : "a message of " + who + " under another name";
}

bool publishes_itself(zmq::message_t& topic, const std::string& publisher) {
  return sender_of(topic) == publisher;
}

bool publishes_or_is_forwarded(zmq::message_t& topic, const std::string& publisher) {
  return publishes_itself(topic, publisher) || may_speak_for(topic, publisher);
}

}  // namespace dmise
