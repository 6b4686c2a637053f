#pragma once
#include <cstddef>

namespace dmise {

struct Sgp4Scale {
  double ns_per_object = 0.0;  // median of propagating all
  double peak_mb = 0.0;        // VmHWM of the process
};

/// Propagates `objects` of the synthetic catalogue in a process of its own: builds the batch from
/// elements generated in chunks, or with `keep_elements` all in memory, and propagates it several
/// times into arrays of position, velocity and code, on one thread. Throws `Error` if that fails.
Sgp4Scale sgp4_at_scale(std::size_t objects, bool keep_elements);

}  // namespace dmise
