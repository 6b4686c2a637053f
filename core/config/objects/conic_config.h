#pragma once
#include <string>
#include <vector>

#include "core/frames/geodesy.h"
#include "core/orbit/motion.h"
#include "core/time/julian_date.h"

namespace dmise {

class YamlValue;
struct Section;

/// The keys of `motion.two_body`.
const Section& two_body_section();
/// The keys of `motion.numerical`: those of a conic but for its gravity.
const Section& numerical_section();

/// Reads a conic, or the state at an epoch from which an object flies by numerical integration, by
/// one of the sections above; `start` is the default epoch. Adds lines to `warnings` for elements
/// that are unusual. Throws `ConfigError` `file:line:column: key: reason`.
TwoBodyMotion read_conic(const YamlValue& value, const Section& section, const Utc& start,
                         const Ellipsoid& ellipsoid, std::vector<std::string>& warnings);

/// Fails at `value` if a place is inside the ellipsoid.
void require_outside_earth(const YamlValue& value, const Vec<Gcrs>& position_m,
                           const Ellipsoid& ellipsoid);
inline void require_outside_earth(const YamlValue& value, const Vec<Itrs>& position_m,
                                  const Ellipsoid& ellipsoid) {
  require_outside_earth(value, Vec<Gcrs>{position_m.x, position_m.y, position_m.z}, ellipsoid);
}

}  // namespace dmise
