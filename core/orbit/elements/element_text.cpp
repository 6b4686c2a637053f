#include "core/orbit/elements/element_text.h"

#include <erfa.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/elements/tle.h"

namespace dmise {

namespace {

constexpr double rev_per_day = 1440.0 / (2.0 * pi);  // in one rad/min

std::string alpha5(std::uint32_t number) {
  if (number < 100000) return formatted("%05u", number);
  if (number > 339999)
    throw Error("catalogue number does not fit a TLE, got " + std::to_string(number));
  const char* letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";
  return formatted("%c%04u", letters[number / 10000 - 10], number % 10000);
}

/// " 12345-3": five digits after an assumed point and a power of ten.
std::string exponent_field(double value) {
  if (value == 0) return " 00000-0";
  int power = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  long digits = std::lround(std::abs(value) * std::pow(10.0, 5 - power));
  if (digits >= 100000) {
    digits /= 10;
    ++power;
  }
  if (power < -9) return " 00000-0";
  if (power > 9) throw Error("value does not fit a TLE, got " + std::to_string(value));
  return formatted("%c%05ld%c%d", value < 0 ? '-' : ' ', digits, power < 0 ? '-' : '+',
                   std::abs(power));
}

std::string epoch_field(const MeanElements& e) {
  long fraction = std::lround(e.epoch_jd2 * 1e8);
  const double midnight = e.epoch_jd1 + (fraction >= 100000000 ? 1 : 0);
  fraction %= 100000000;
  int year = 0, month = 0, day = 0;
  double rest = 0.0;
  eraJd2cal(midnight, 0.0, &year, &month, &day, &rest);
  if (year < 1957 || year > 2056)
    throw Error("epoch does not fit a TLE, got year " + std::to_string(year));
  const int day_of_year = static_cast<int>(midnight - julian_midnight(year, 1)) + 1;
  return formatted("%02d%03d.%08ld", year % 100, day_of_year, fraction);
}

std::string with_checksum(const std::string& line) {
  return line + static_cast<char>('0' + tle_checksum(line));
}

}  // namespace

std::string omm_designator(const std::string& id) {
  const auto digit = [&](std::size_t i) { return id[i] >= '0' && id[i] <= '9'; };
  if (id.size() < 6 || !digit(0) || !digit(1) || !digit(2)) return id;
  return std::to_string(full_year((id[0] - '0') * 10 + id[1] - '0')) + "-" + id.substr(2);
}

std::string format_tle(const MeanElements& e) {
  const double dot = e.mean_motion_dot_rad_per_min2 * (rev_per_day * 1440.0);
  const double ddot = e.mean_motion_ddot_rad_per_min3 * (rev_per_day * 1440.0 * 1440.0);
  const std::string dot_text = formatted("%.8f", std::abs(dot));  // "0.00000184": the zero goes
  const std::string line1 = "1 " + alpha5(e.catalogue_number) + e.classification + " " +
                            formatted("%-8.8s ", e.designator.c_str()) + epoch_field(e) +
                            (dot < 0 ? " -" : "  ") + dot_text.substr(dot_text.find('.')) + " " +
                            exponent_field(ddot) + " " + exponent_field(e.bstar_per_earth_radius) +
                            formatted(" %d %4d", e.ephemeris_type % 10, e.element_number % 10000);
  const std::string line2 =
      "2 " + alpha5(e.catalogue_number) +
      formatted(" %8.4f %8.4f %07ld", e.inclination_rad / deg, e.raan_rad / deg,
                std::min(9999999L, std::lround(e.eccentricity * 1e7))) +
      formatted(" %8.4f %8.4f %11.8f%5d", e.argument_of_perigee_rad / deg, e.mean_anomaly_rad / deg,
                e.mean_motion_rad_per_min * rev_per_day, e.revolution % 100000);
  return with_checksum(line1) + "\n" + with_checksum(line2) + "\n";
}

std::string format_3le(std::span<const MeanElements> catalogue) {
  std::string text;
  text.reserve(catalogue.size() * 165);
  for (const MeanElements& e : catalogue) text += "0 " + e.name + "\n" + format_tle(e);
  return text;
}

std::string format_omm_csv(std::span<const MeanElements> catalogue) {
  std::string text =
      "OBJECT_NAME,OBJECT_ID,EPOCH,MEAN_MOTION,ECCENTRICITY,INCLINATION,RA_OF_ASC_NODE,"
      "ARG_OF_PERICENTER,MEAN_ANOMALY,EPHEMERIS_TYPE,CLASSIFICATION_TYPE,NORAD_CAT_ID,"
      "ELEMENT_SET_NO,REV_AT_EPOCH,BSTAR,MEAN_MOTION_DOT,MEAN_MOTION_DDOT\n";
  text.reserve(catalogue.size() * 180);
  for (const MeanElements& e : catalogue) {
    text += csv_field(e.name) + "," + omm_designator(e.designator) + ",";
    text += format_iso_epoch({e.epoch_jd1, e.epoch_jd2}, 6);
    text += formatted(",%.8f,%.8f,%.4f,%.4f", e.mean_motion_rad_per_min * rev_per_day,
                      e.eccentricity, e.inclination_rad / deg, e.raan_rad / deg);
    text += formatted(",%.4f,%.4f,%d,%c", e.argument_of_perigee_rad / deg, e.mean_anomaly_rad / deg,
                      e.ephemeris_type, e.classification);
    text += formatted(",%u,%d,%d", e.catalogue_number, e.element_number, e.revolution);
    text += formatted(",%.8g,%.8g,%.8g\n", e.bstar_per_earth_radius,
                      e.mean_motion_dot_rad_per_min2 * (rev_per_day * 1440.0),
                      e.mean_motion_ddot_rad_per_min3 * (rev_per_day * 1440.0 * 1440.0));
  }
  return text;
}

}  // namespace dmise
