#pragma once
#include <cmath>
#include <cstdlib>
#include <string>

#include "core/base/units.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/sgp4/catalogue_report.h"

namespace dmise::fuzz {

/// Ends the program, for the fuzzer to see, unless `held`.
inline void require(bool held) {
  if (!held) std::abort();
}

/// What holds of every catalogue that was read, whatever the text.
inline void require_sound(const CatalogueFile& file) {
  for (const MeanElements& e : file.elements) {
    require(e.catalogue_number <= 999'999'999);
    require(e.eccentricity >= 0 && e.eccentricity < 1);
    require(e.mean_motion_rad_per_min > 0 && e.mean_motion_rad_per_min < 1);
    require(e.inclination_rad >= 0 && e.inclination_rad <= pi);
    for (const double angle_rad : {e.raan_rad, e.argument_of_perigee_rad, e.mean_anomaly_rad})
      require(angle_rad >= 0 && angle_rad <= 2 * pi);
    for (const double value : {e.bstar_per_earth_radius, e.mean_motion_dot_rad_per_min2,
                               e.mean_motion_ddot_rad_per_min3})
      require(std::isfinite(value));
    require(e.epoch_jd1 - std::floor(e.epoch_jd1) == 0.5);
    require(e.epoch_jd2 >= 0 && e.epoch_jd2 < 1);
  }
  for (const CatalogueProblem& problem : file.refused)
    require(problem.line > 0 && !problem.reason.empty());
  require(!format(report_of(file)).empty());
}

}  // namespace dmise::fuzz
