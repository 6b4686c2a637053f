#pragma once

namespace dmise {

/// Measures the propagator and prints a table, or one JSON object per line. Returns 0 if every
/// target is met. Reference values and the speed anchor come from bench/sgp4_anchor.py in the same
/// run, with the interpreter `$DMISE_PYTHON` (python3); without it they are skipped. The catalogue
/// is the real one under `$DMISE_DATA`, else random.
int bench_sgp4(bool json);

}  // namespace dmise
