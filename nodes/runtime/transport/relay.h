#pragma once
#include <cstdint>
#include <zmq.hpp>

#include "nodes/runtime/transport/own_name.h"

namespace dmise {

/// Messages in one direction before looking at the other.
inline constexpr int relay_burst = 1000;

/// Passes on what waits at `from`, message by message, up to `relay_burst` of them; returns how
/// many.
int pass_on(zmq::socket_t& from, zmq::socket_t& to);

/// The same from publishers whose names are proved by keys. What is published in a name in which
/// its sender may not speak goes nowhere and is counted in `refused`; the first is logged.
int pass_checked(zmq::socket_t& from, zmq::socket_t& to, MayPublish may_publish,
                 std::uint64_t* refused);

/// Passes on subscriptions, to a topic that can be one. What else subscribers send goes nowhere.
int pass_subscriptions(zmq::socket_t& from, zmq::socket_t& to);

}  // namespace dmise
