#pragma once
#include <span>

namespace dmise {

/// Adds to `light_e` the charge expected to leave the traps during an exposure, after they had
/// `idle_s` since the last one to empty: trapped exp(-idle / tau) (1 - exp(-exposure / tau)). What
/// has left is no longer in `trapped_e`.
void release_trapped(double tau_s, double idle_s, double exposure_s, std::span<float> trapped_e,
                     std::span<float> light_e);

/// Traps `fraction` of what was collected.
void trap(double fraction, std::span<const float> collected_e, std::span<float> trapped_e);

}  // namespace dmise
