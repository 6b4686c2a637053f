#pragma once
#include <cstdint>
#include <zmq.hpp>

#include "nodes/runtime/transport/own_name.h"

namespace dmise {

/// Number of messages in one direction before switching to the other.
inline constexpr int relay_burst = 1000;

/// Forwards up to `relay_burst` waiting messages from `from`; returns how many.
int relay_messages(zmq::socket_t& from, zmq::socket_t& to);

/// Relay for publishers authenticated by keys. Messages under a name that the sender may not use
/// are dropped and counted in `refused`; the first is logged.
int relay_checked(zmq::socket_t& from, zmq::socket_t& to, MayPublish may_publish,
                  std::uint64_t* refused);

/// Forwards subscriptions to valid topics; drops everything else from subscribers.
int relay_subscriptions(zmq::socket_t& from, zmq::socket_t& to);

}  // namespace dmise
