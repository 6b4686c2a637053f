#pragma once
#include <zmq.hpp>

namespace dmise {

/// Passes on what waits at `from`, message by message, up to `burst` of them; returns how many.
int pass_on(zmq::socket_t& from, zmq::socket_t& to, int burst = 1000);

}  // namespace dmise
