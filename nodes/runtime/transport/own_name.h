#pragma once
#include <optional>
#include <string>
#include <zmq.hpp>

#include "dmise/v1/node.pb.h"

// In whose name a sender may speak, where there are keys: in that of its key, and the agent of a
// host in that of nodes which its key is granted.
namespace dmise {

/// Why the sender of `message` may not say it; nothing when it may. `frame`: the message as it
/// came. `connection`: who stands behind its connection, "" if nobody yet.
std::optional<std::string> fault_of_sender(const v1::NodeMessage& message, zmq::message_t& frame,
                                           const std::string& connection);

/// Whether a sender may publish as `publisher`. `topic`: first frame of the message.
using MayPublish = bool (*)(zmq::message_t& topic, const std::string& publisher);
/// The process whose name it is, over a connection of its own.
bool publishes_itself(zmq::message_t& topic, const std::string& publisher);
/// That process, or an agent that may speak for it.
bool publishes_or_is_passed_on(zmq::message_t& topic, const std::string& publisher);

}  // namespace dmise
