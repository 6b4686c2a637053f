#pragma once

namespace dmise {

/// Error and cost of interpolation between ticks, by tick length and order, over a whole catalogue:
/// the public one of 2019 under $DMISE_DATA, else a synthetic one of 18,470 objects. Prints one
/// line per value, JSON or text. Returns an exit code.
int bench_interpolation(bool json);

}  // namespace dmise
