#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/propagation/object_population.h"

namespace dmise {

/// A class of orbits by which a survey counts.
struct Shell {
  std::string name;         // "600-800 km", "MEO", ...
  std::size_t objects = 0;  // how many objects of the population are in it
};

/// The shells of a population: bands of mean altitude of low orbits (a period below 127 min), then
/// MEO, GEO, HEO (e >= 0.25), what is beyond GEO, and objects without element sets.
struct Shells {
  std::vector<Shell> shells;
  std::vector<std::uint8_t> of_object;  // index into `shells`, by object
};

/// Limits [km] between the bands of low orbits.
inline constexpr double usual_shell_limits_km[] = {450.0, 600.0, 800.0, 1000.0, 1500.0};

/// `limits_km`: ascending, > 0, at most 32; may be empty.
Shells shells_of(const ObjectPopulation& population, const std::vector<double>& limits_km);

/// Semi-major axis less the Earth's equatorial radius [km].
double mean_altitude_km(const MeanElements& elements);

}  // namespace dmise
