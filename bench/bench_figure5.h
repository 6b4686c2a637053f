#pragma once
namespace dmise {

/// The paper's Figure 5 on one thread: 18,470 objects over 24 h at 10 s from a site at Atlanta, who
/// is in the 90 deg field, above the mask and sunlit, with their ranges. Prints figure5_s, thread
/// CPU time of set-up, propagation, tests and collecting (the catalogue is read before; median of
/// three), and compares the pairs of object and instant with those of asking for every object at
/// every instant: over an hour, or over the day when `$DMISE_BENCH_WHOLE` is set. 0 when the time
/// is within its target and no pair differs. The catalogue is the real one under `$DMISE_DATA`,
/// else synthetic.
int bench_figure5(bool json);

}  // namespace dmise
