#pragma once
#include <cstdint>
#include <vector>

#include "core/orbit/interpolation.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/time/julian_date.h"

namespace dmise {

struct CatalogueInterpolationOptions {
  HermiteOrder order = HermiteOrder::cubic;
  double tick_s = 10.0;
  int intervals = 4;  // whole ticks, one after another
  int samples = 8;    // equidistant inner points of each
};

/// Error of interpolation between ticks for each object of a catalogue, relative to SGP4.
struct CatalogueInterpolationError {
  std::vector<double> max_m;       // greatest distance found; 0 where there is a code
  std::vector<std::uint8_t> code;  // why SGP4 had no state at the first such time, else 0
};

/// Measures the error from `start` on, in TEME, with slopes from symmetric differences of the
/// positions.
CatalogueInterpolationError measure_catalogue_interpolation(
    const Sgp4Batch& batch, const Utc& start, const CatalogueInterpolationOptions& options);

}  // namespace dmise
