#pragma once

namespace dmise {

/// Fusion of many sensors: the time of a tick with a full catalogue, and purity and completeness of
/// tracks in an hour of eight sites that are simulated by their detections alone. Prints one line
/// per value, JSON or text. Returns an exit code.
int bench_fusion_tick(bool json);

}  // namespace dmise
