#pragma once

namespace dmise {

/// Milliseconds of one core for the sky of the paper's all-sky frame (all parts, within 0.5 %)
/// beside evaluating every pixel, and for finding, placing and weighing the stars of a wide and of
/// a narrow field of Debian's catalogue. Prints a line a figure, JSON or text. Returns an exit
/// code.
int bench_sky(bool json);

}  // namespace dmise
