#pragma once
#include <cstddef>

namespace dmise {

struct Sgp4Scale {
  double ns_per_object = 0.0;  // of one propagation of all, median
  double peak_mb = 0.0;        // VmHWM of the process
};

/// `objects` of the synthetic catalogue in a process of its own: builds the batch from elements
/// that are made piece by piece - or, with `keep_elements`, all held beside it - propagates it a
/// few times into arrays of position, velocity and code, on one thread. Throws `Error` when that
/// fails.
Sgp4Scale sgp4_at_scale(std::size_t objects, bool keep_elements);

}  // namespace dmise
