#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/config/yaml_reader.h"

namespace dmise {

// Figures that a model can compute with and no telescope has, mostly a unit's power of ten off.
// Each line is `file:line:column: key: reason, got value`; empty: all are in proportion.

/// Of the mapping `camera`, as read into `read`.
std::vector<std::string> disproportions_of_camera(const YamlValue& camera, const Camera& read);

/// Of the mapping `two_body`, whose orbit has these apsides from the Earth's centre (apoapsis
/// infinite for open orbits).
std::vector<std::string> disproportions_of_orbit(const YamlValue& two_body, double periapsis_m,
                                                 double apoapsis_m);

}  // namespace dmise
