#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/orbit/elements/elements.h"
#include "core/time/julian_date.h"

namespace dmise {

struct SyntheticCatalogueOptions {
  std::size_t objects = 0;  // up to 1,000,000
  std::size_t first = 0;    // objects first .. first + objects - 1 of the population
  std::uint64_t seed = 1;
  Utc newest_epoch{2458138.5, 0.0};  // 2018-01-20; epochs lie within the three days before it
};

/// Generates a population like the catalogued one of the 2020s, for tests of scale: object i is a
/// function of (seed, i) alone, so a smaller catalogue is a prefix of a larger one. Numbers start
/// at 1. Elements have the digits of a TLE, so a written catalogue reads back to the same bits.
///
/// Shares: 39 % shells of constellations (550 km at 53.0 deg, 540 at 53.2, 570 at 70, 560 at 97.6,
/// 1200 at 87.9), 18 % payloads and stages (Sun-synchronous 450-850 km; 65, 74, 83 deg to 1500 km),
/// 30 % debris of break-ups (700-1500 km at 65, 74-83 and 98.6 deg, exponential apogees), 2.5 %
/// navigation (19,130 and 20,200 km), 5.5 % geostationary (belt and graveyard, inclined to 15 deg),
/// 1 % Molniya (12 h, 63.4 deg, e 0.68-0.74), 4 % transfer orbits. Nodes and anomalies are uniform.
/// Throws `Error` for objects beyond the first 1,000,000.
std::vector<MeanElements> synthetic_catalogue(const SyntheticCatalogueOptions& options);

}  // namespace dmise
