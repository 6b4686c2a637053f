#pragma once
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/orbit/elements/elements.h"

// The least that turns well-formed TLE lines into mean elements; the product's reader does the
// rest.
namespace dmise::test {

/// A field as C reads it: 0 if it is blank.
inline double number(const std::string& field) { return std::strtod(field.c_str(), nullptr); }
inline int whole_number(const std::string& field) {
  return int(std::strtol(field.c_str(), nullptr, 10));
}

inline double tle_exponent(const std::string& field) {  // " 12345-3" is 0.12345e-3
  const double mantissa = number(field.substr(0, 1) + "." + field.substr(1, 5));
  return mantissa * std::pow(10.0, whole_number(field.substr(6, 2)));
}

inline double julian_date_of_year(int year) {  // at January 0, 0h
  const int y = year - 1;
  const int leap_days = y / 4 - y / 100 + y / 400;
  return 1721424.5 + 365.0 * y + leap_days;
}

inline MeanElements elements_from_tle(const std::string& line1, const std::string& line2,
                                      const std::string& name = "") {
  MeanElements e;
  e.name = name;
  const char first = line1[2];
  const std::string digits = line1.substr(3, 4);
  int lead = first >= 'A' ? first - 'A' + 10 - (first > 'I') - (first > 'O')
                          : whole_number(line1.substr(2, 1));
  e.catalogue_number = std::uint32_t(lead * 10000 + whole_number(digits));
  const int year = whole_number(line1.substr(18, 2));
  e.epoch_jd1 = julian_date_of_year(year < 57 ? 2000 + year : 1900 + year) +
                whole_number(line1.substr(20, 3));
  e.epoch_jd2 = number("0" + line1.substr(23, 9));
  e.mean_motion_rad_per_min = number(line2.substr(52, 11)) / (1440.0 / (2.0 * pi));
  std::string eccentricity = line2.substr(26, 7);
  for (char& c : eccentricity)
    if (c == ' ') c = '0';
  e.eccentricity = number("0." + eccentricity);
  e.inclination_rad = number(line2.substr(8, 8)) * deg;
  e.raan_rad = number(line2.substr(17, 8)) * deg;
  e.argument_of_perigee_rad = number(line2.substr(34, 8)) * deg;
  e.mean_anomaly_rad = number(line2.substr(43, 8)) * deg;
  e.bstar_per_earth_radius = tle_exponent(line1.substr(53, 8));
  return e;
}

/// Every pair of lines "1 ..." and "2 ..." in a text; other lines are names or comments.
inline std::vector<MeanElements> elements_from_text(const std::string& text) {
  std::vector<MeanElements> all;
  std::istringstream in(text);
  std::string line, line1;
  while (std::getline(in, line)) {
    if (line.size() >= 61 && line.compare(0, 2, "1 ") == 0) line1 = line;
    if (line.size() >= 63 && line.compare(0, 2, "2 ") == 0 && !line1.empty()) {
      all.push_back(elements_from_tle(line1, line));
      line1.clear();
    }
  }
  return all;
}

}  // namespace dmise::test
