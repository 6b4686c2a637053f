#pragma once
#include <string>
#include <string_view>

#include "core/orbit/oem.h"

namespace dmise {

/// Reads the orbit of one satellite from an SP3-c or SP3-d, optionally gzipped, in ITRF.
/// `satellite` is its identifier in the file in any case, such as "L74"; empty: the file has no
/// other. With velocities, positions are joined by Hermite polynomials of degree 11 (six epochs),
/// else by Lagrange's of degree 9 (ten). An epoch without a position, one that is missing and a
/// manoeuvre (M in column 79) interrupt the trajectory; what remains between two of them is left
/// out if it has fewer epochs than a polynomial needs. Clocks, accuracies and correlations are
/// ignored. Hilla 2016, "The Extended Standard Product 3 Orbit Format (SP3-d)". Throws
/// `ConfigError` `file:line:column: reason, got "value"`.
Trajectory read_sp3(const std::string& path, const std::string& satellite = "");
Trajectory parse_sp3(std::string_view text, const std::string& source,
                     const std::string& satellite = "");

}  // namespace dmise
