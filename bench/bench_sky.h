#pragma once

namespace dmise {

/// Milliseconds of one core for the sky of the paper's all-sky frame (all components, within 0.5 %)
/// compared to evaluating every pixel, and for the stars of a wide and a narrow field of Debian's
/// catalogue. Prints one line per value, JSON or text. Returns an exit code.
int bench_sky(bool json);

}  // namespace dmise
