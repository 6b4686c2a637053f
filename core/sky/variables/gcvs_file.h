#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// A star of the General Catalogue of Variable Stars as its file has it.
struct VariableRecord {
  std::string name, type;
  double ra_rad = 0.0, dec_rad = 0.0;  // J2000.0
  std::optional<double> brightest_mag, depth_mag, second_depth_mag;
  std::string band;                       // that the magnitudes are in; "V" is Johnson's
  std::optional<double> epoch_hjd;        // heliocentric Julian date
  std::optional<double> period_d;         // > 0
  std::optional<double> share_of_period;  // (0, 1): of the rise, or of an eclipse
};

/// A file, and each of its lines that could not be used: `file:line:column: reason`.
struct VariableReading {
  std::vector<VariableRecord> stars;
  std::vector<std::string> problems;
  std::size_t without_place = 0;  // stars whose place is not known
};

/// Reads the catalogue (gcvs5.txt of the Sternberg Institute, gcvs_cat.dat of CDS B/gcvs): twelve
/// fields and more between bars, of which these are used: name, place of J2000.0, type, magnitudes
/// at maximum and at both minima (an amplitude where in brackets), band, epoch (JD - 2400000),
/// period and share of the period [%]. A limit of a magnitude stands for it; one of a period for
/// none. Lines before the first star and those that begin with '#' are passed over; `name` is the
/// file as problems call it. Throws `ConfigError` if no line is a star, with the first problem.
VariableReading parse_gcvs(std::string_view text, const std::string& name);

}  // namespace dmise
