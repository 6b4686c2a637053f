#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/orbit/elements/catalogue.h"
#include "core/time/julian_date.h"

namespace dmise {

/// Elements older than this are reported as stale: in low orbit SGP4 is then tens of kilometres
/// off.
inline constexpr double stale_after_days = 30.0;

/// `at` minus the epoch of the elements [days]; < 0 before it.
double element_age_days(const MeanElements& elements, const Utc& at);

/// Orbit classes by period and eccentricity.
enum class OrbitRegime { low, medium, geosynchronous, highly_elliptic, beyond };

OrbitRegime regime_of(const MeanElements& elements);

/// Semi-major axis of the mean motion, with the constants of SGP4 (WGS72).
double semi_major_axis_km(const MeanElements& elements);

/// Content of `dmise catalogue info FILE`.
struct CatalogueReport {
  std::string source;
  CatalogueFormat format = CatalogueFormat::tle;
  std::size_t records = 0;
  std::size_t objects = 0;
  std::size_t refused = 0;
  std::size_t superseded = 0;
  std::size_t warnings = 0;
  std::size_t deep_space = 0;     // period >= 225 min: SDP4
  std::size_t stale = 0;          // at `at`
  std::size_t by_regime[5] = {};  // indexed by OrbitRegime
  std::optional<Utc> oldest_epoch, newest_epoch;
  Utc at;                                                   // reference time of ages
  double lowest_perigee_km = 0.0, highest_apogee_km = 0.0;  // above 6378.135 km
  std::vector<std::string> problems;  // `file:line: reason`, refused first, then warnings
};

/// Ages are counted to `at`, or to the newest epoch of the file.
CatalogueReport report_of(const CatalogueFile& file, const std::optional<Utc>& at = std::nullopt);

/// Formats the report as text, with at most `problems` problems and the number of the others.
std::string format(const CatalogueReport& report, std::size_t problems = 10);

}  // namespace dmise
