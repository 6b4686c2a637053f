#pragma once
#include <zmq.hpp>

namespace dmise {

/// Messages in one direction before looking at the other.
inline constexpr int relay_burst = 1000;

/// Passes on what waits at `from`, message by message, up to `relay_burst` of them; returns how
/// many.
int pass_on(zmq::socket_t& from, zmq::socket_t& to);

}  // namespace dmise
