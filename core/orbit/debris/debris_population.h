#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/orbit/debris/debris_flux.h"
#include "core/orbit/elements/elements.h"
#include "core/time/julian_date.h"

namespace dmise {

inline constexpr int max_debris_objects = 1'000'000;

/// Debris on circular orbits within a shell, as many as make the published flux.
struct DebrisPopulation {
  std::string name;                // objects are NAME-NUMBER, from 1, the largest first
  std::uint32_t first_number = 0;  // catalogue number of the first
  double year = 2000.0;            // when the flux is, with its fraction
  double solar_flux_sfu = 130.0;   // at 10.7 cm, over the year before
  double scale = 1.0;              // factor of the flux
  double min_size_m = 0.01;        // diameters
  double max_size_m = 0.1;
  double min_height_m = 200e3;  // semi-major axis less 6378137 m
  double max_height_m = 2000e3;
  InclinationCounts inclinations{};   // whose distribution the objects have
  std::optional<std::uint64_t> seed;  // none: the scenario's
  Utc epoch;

  /// Mean of the number of objects, which is Poisson's.
  double mean_count() const;
  /// Catalogue numbers that are kept for them: beyond chance, enough.
  int numbers() const;
};

/// Objects of element sets whose semi-major axes are at these heights, by degree of inclination.
InclinationCounts inclinations_of(std::span<const MeanElements> elements, double min_height_m,
                                  double max_height_m);

struct DrawnDebris {
  std::vector<MeanElements> elements;  // for SGP4, without drag
  std::vector<double> diameters_m;     // one for each of `elements`, descending
};

/// Draws the objects. Sizes are a Poisson process from the largest down: with the same seed a
/// smaller `min_size_m` adds objects and changes no other. A population and a seed give the same
/// bytes anywhere.
DrawnDebris draw_debris(const DebrisPopulation& population, std::uint64_t scenario_seed);

/// One line: numbers and sizes.
std::string describe(const DebrisPopulation& population, const DrawnDebris& drawn);

}  // namespace dmise
