#pragma once

namespace dmise {

/// Error of interpolating between ticks and its cost, by tick length and order, over a whole
/// catalogue: the public one of 2019 under $DMISE_DATA, else a synthetic one of 18,470 objects.
/// Prints a line a figure, JSON or text. Returns an exit code.
int bench_interpolation(bool json);

}  // namespace dmise
