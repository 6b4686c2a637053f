#pragma once

namespace dmise {

/// Orbits of catalogued satellites kept over days by directions that are drawn about precise orbits
/// ($DMISE_DATA): error and consistency after a day, and logged manoeuvres that are found. Prints
/// one line per value, JSON or text. Returns an exit code.
int bench_catalogue(bool json);

}  // namespace dmise
