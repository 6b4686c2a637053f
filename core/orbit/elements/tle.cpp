#include "core/orbit/elements/tle.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/files/text_fields.h"
#include "core/orbit/elements/epoch.h"

namespace dmise {

namespace {

constexpr std::size_t full_length = 69;

/// Columns `first` to `last`, both counted from 1 as in the format's description.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  if (line.size() < first) return {};
  return line.substr(first - 1, last - first + 1);
}

std::string zeros_for_blanks(std::string_view field) {
  std::string digits(field);
  std::replace(digits.begin(), digits.end(), ' ', '0');
  return digits;
}

/// "[+- ]ddddd[+- ]d": a mantissa after an assumed decimal point, and a power of ten. Blank is 0.
double exponent_field(std::string_view field, const char* what) {
  if (trimmed(field).empty()) return 0.0;
  const char sign = field.front(), power_sign = field[6];
  const auto mantissa = parse_real("." + zeros_for_blanks(field.substr(1, 5)));
  const auto power = parse_count(zeros_for_blanks(field.substr(7, 1)));
  const auto is_sign = [](char c) { return c == ' ' || c == '+' || c == '-'; };
  if (!is_sign(sign) || !is_sign(power_sign) || !mantissa || !power)
    throw RecordError(std::string(what) + " is not a number" + got(field));
  const double value = *mantissa * std::pow(10.0, power_sign == '-' ? -double(*power) : *power);
  return sign == '-' ? -value : value;
}

Utc epoch_field(std::string_view field) {
  const auto year = parse_count(trimmed(field.substr(0, 2)));
  const auto day = parse_count(trimmed(field.substr(2, 3)));
  const auto fraction = parse_real(zeros_for_blanks(trimmed(field.substr(5))));
  if (!year || !day || !fraction || *fraction < 0 || *fraction >= 1)
    throw RecordError("epoch is not a year and day" + got(field));
  const int full = full_year(static_cast<int>(*year));
  if (*day < 1 || *day > (is_leap_year(full) ? 366u : 365u))
    throw RecordError("epoch day out of range" + got(field));
  return {julian_midnight(full, static_cast<int>(*day)), *fraction};
}

/// Refuses a misaligned line: a lost or doubled character shifts every field.
void check_layout(std::string_view line, char number, std::initializer_list<std::size_t> blanks,
                  std::initializer_list<std::size_t> points) {
  const std::string name = std::string("line ") + number;
  if (line.empty() || line[0] != number) throw RecordError("not " + name + got(line));
  for (const char c : line)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e)
      throw RecordError(name + " holds a character that is not printable ASCII" + got(line));
  for (const std::size_t column : blanks)
    if (line.size() >= column && line[column - 1] != ' ')
      throw RecordError(name + " has no blank in column " + std::to_string(column) + got(line));
  for (const std::size_t column : points)
    if (line.size() < column || line[column - 1] != '.')
      throw RecordError(name + " has no '.' in column " + std::to_string(column) + got(line));
}

/// Drops text after column 69 and checks length and checksum. `needed`: last column with an
/// element.
std::string_view checked_line(std::string_view line, char number, std::size_t needed, bool lenient,
                              std::string* warning) {
  const std::string name = std::string("line ") + number;
  if (line.size() > full_length && line[full_length] == ' ') line = line.substr(0, full_length);
  while (!line.empty() && line.back() == ' ') line.remove_suffix(1);
  std::string fault;
  if (line.size() > full_length)
    throw RecordError(name + " has " + std::to_string(line.size()) + " columns, not 69" +
                      got(line));
  if (line.size() < full_length - 1) {
    fault = name + " has " + std::to_string(line.size()) + " columns, not 69" + got(line);
    if (line.size() < needed) throw RecordError(fault);
  } else if (line.size() == full_length - 1) {
    fault = name + " has no checksum" + got(line);
  } else if (const int sum = tle_checksum(line); line.back() != '0' + sum) {
    fault = name + " has a wrong checksum, expected " + std::to_string(sum) +
            got(line.substr(full_length - 1));
  }
  if (fault.empty()) return line;
  if (!lenient) throw RecordError(fault);
  if (warning) *warning += (warning->empty() ? "" : "; ") + fault;
  return line;
}

}  // namespace

std::uint32_t parse_alpha5(std::string_view columns) {
  const std::string_view text = trimmed(columns);
  if (text.size() == 5 && text[0] >= 'A' && text[0] <= 'Z' && text[0] != 'I' && text[0] != 'O') {
    const auto rest = parse_count(text.substr(1));
    const std::uint32_t letter =
        static_cast<std::uint32_t>(text[0] - 'A') + 10 - (text[0] > 'I') - (text[0] > 'O');
    if (rest && text[1] != '+') return letter * 10000 + *rest;
  } else if (const auto number = parse_count(text); number && text[0] != '+') {
    return *number;
  }
  throw RecordError("catalogue number is neither digits nor Alpha-5" + got(columns));
}

int tle_checksum(std::string_view line) {
  int sum = 0;
  for (const char c : line.substr(0, full_length - 1)) {
    if (c >= '0' && c <= '9') sum += c - '0';
    if (c == '-') ++sum;
  }
  return sum % 10;
}

MeanElements parse_tle(std::string_view line1, std::string_view line2, bool lenient,
                       std::string* warning) {
  line1 = checked_line(line1, '1', 63, lenient, warning);
  line2 = checked_line(line2, '2', 63, lenient, warning);
  check_layout(line1, '1', {2, 9, 18, 33, 44, 53, 62, 64}, {24, 35});
  check_layout(line2, '2', {2, 8, 17, 26, 34, 43, 52}, {12, 21, 38, 47, 55});

  MeanElements e;
  e.catalogue_number = parse_alpha5(columns(line1, 3, 7));
  if (parse_alpha5(columns(line2, 3, 7)) != e.catalogue_number)
    throw RecordError("line 2 is of another object than line 1" + got(columns(line2, 3, 7)));
  e.classification = line1[7] == ' ' ? 'U' : line1[7];
  e.designator = trimmed(columns(line1, 10, 17));
  const Utc epoch = epoch_field(columns(line1, 19, 32));
  e.epoch_jd1 = epoch.jd1;
  e.epoch_jd2 = epoch.jd2;
  e.ephemeris_type = count_or_zero(columns(line1, 63, 63), "ephemeris type");
  check_ephemeris_type(e.ephemeris_type);
  e.element_number = count_or_zero(columns(line1, 65, 68), "element set number");
  e.bstar_per_earth_radius = exponent_field(columns(line1, 54, 61), "drag term");
  e.revolution = count_or_zero(columns(line2, 64, 68), "revolution number");

  PublishedOrbit orbit;
  orbit.mean_motion_dot_rev_per_day2 =
      real_in(zeros_for_blanks(trimmed(columns(line1, 34, 43))), "mean motion dot", -1, 1);
  orbit.mean_motion_ddot_rev_per_day3 = exponent_field(columns(line1, 45, 52), "mean motion ddot");
  orbit.inclination_deg = real_in(columns(line2, 9, 16), "inclination", 0, 180);
  orbit.raan_deg = real_in(columns(line2, 18, 25), "right ascension of node", 0, 360);
  orbit.eccentricity =
      real_in("." + zeros_for_blanks(columns(line2, 27, 33)), "eccentricity", 0, 1);
  orbit.argument_of_perigee_deg = real_in(columns(line2, 35, 42), "argument of perigee", 0, 360);
  orbit.mean_anomaly_deg = real_in(columns(line2, 44, 51), "mean anomaly", 0, 360);
  orbit.mean_motion_rev_per_day = real_in(columns(line2, 53, 63), "mean motion", 1e-8, 100);
  set_orbit(orbit, e);
  return e;
}

}  // namespace dmise
