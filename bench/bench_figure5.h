#pragma once
namespace dmise {

/// The paper's Figure 5 on one thread: 18,470 objects over 24 h at 10 s from a site at Atlanta:
/// which are in the 90 deg field, above the mask and sunlit, with their ranges. Prints figure5_s,
/// thread CPU time of set-up, propagation, tests and collecting (without reading the catalogue;
/// median of three), and compares the pairs of object and instant with a test of every object at
/// every instant: over an hour, or over the day if `$DMISE_BENCH_WHOLE` is set. Returns 0 if the
/// time is within its target and no pair differs. The catalogue is the real one under
/// `$DMISE_DATA`, else synthetic.
int bench_figure5(bool json);

}  // namespace dmise
