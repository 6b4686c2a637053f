#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"

namespace dmise {

class YamlValue;

// Warnings of values that a model can compute with but no telescope or orbit has, mostly errors of
// a unit. Each line is `file:line:column: key: reason, got value`; empty: all values are usual.

/// Of the mapping `camera`, parsed into `read`.
std::vector<std::string> unusual_camera_values(const YamlValue& camera, const Camera& read);

/// Of the mapping `two_body`, whose orbit has these apsides from the Earth's centre (apoapsis
/// infinite for open orbits).
std::vector<std::string> unusual_orbit_values(const YamlValue& two_body, double periapsis_m,
                                              double apoapsis_m, const Ellipsoid& ellipsoid);

}  // namespace dmise
