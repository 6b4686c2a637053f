#pragma once

namespace dmise {

/// Cueing of two telescopes by eight all-sky sites, without pixels: how often a target is detected
/// within two exposures after the slew, and by how much its orbit improves. Prints one line per
/// value, JSON or text. Returns an exit code.
int bench_cue(bool json);

}  // namespace dmise
