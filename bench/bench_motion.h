#pragma once

namespace dmise {

/// Motion by numerical integration: against Orekit's, against precise orbits (under $DMISE_DATA),
/// and its time. Prints one line per value, JSON or text. Returns an exit code.
int bench_motion(bool json);

}  // namespace dmise
