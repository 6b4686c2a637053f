#pragma once
#include <optional>
#include <string>
#include <zmq.hpp>

#include "dmise/v1/node.pb.h"

// Names that a sender may use, with keys: that of its key, and an agent those of nodes granted to
// its key.
namespace dmise {

/// Returns why the sender of `message` may not send it; empty if it may. `frame`: the message as
/// received. `connection`: name of its connection, "" if it has none yet.
std::optional<std::string> fault_of_sender(const v1::NodeMessage& message, zmq::message_t& frame,
                                           const std::string& connection);

/// Whether a sender may publish as `publisher`. `topic`: first frame of the message.
using MayPublish = bool (*)(zmq::message_t& topic, const std::string& publisher);
/// Allows the process of that name, over a connection of its own.
bool publishes_itself(zmq::message_t& topic, const std::string& publisher);
/// Allows that process, or an agent that may speak for it.
bool publishes_or_is_forwarded(zmq::message_t& topic, const std::string& publisher);

}  // namespace dmise
