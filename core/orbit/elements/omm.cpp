#include "core/orbit/elements/omm.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "core/base/files/text_fields.h"
#include "core/orbit/elements/epoch.h"

namespace dmise {

namespace {

/// Units in which SGP4's elements are published (CCSDS 502.0-B, table 4-3), each first as the
/// standard writes it, in capitals without blanks.
using Units = std::array<std::string_view, 4>;
struct UnitsOfKey {
  std::string_view key;
  Units units;
};
constexpr Units degrees = {"DEG", "DEGREE", "DEGREES"};
constexpr UnitsOfKey standard_units[] = {
    {"MEAN_MOTION", {"REV/DAY", "REVS/DAY", "REV/D"}},
    {"ECCENTRICITY", {"N/A", "-", "1"}},
    {"INCLINATION", degrees},
    {"RA_OF_ASC_NODE", degrees},
    {"ARG_OF_PERICENTER", degrees},
    {"MEAN_ANOMALY", degrees},
    {"BSTAR", {"1/ER", "ER**-1", "1/EARTHRADII", "1/[EARTHRADII]"}},
    {"MEAN_MOTION_DOT", {"REV/DAY**2", "REVS/DAY**2", "REV/D**2", "REV/DAY2"}},
    {"MEAN_MOTION_DDOT", {"REV/DAY**3", "REVS/DAY**3", "REV/D**3", "REV/DAY3"}}};

/// A unit in capitals without blanks, with powers as CCSDS writes them.
std::string plain_unit(std::string_view unit) {
  std::string text;
  for (const char c : upper_case(unit))
    if (c == '^')
      text += "**";
    else if (c != ' ' && c != '\t')
      text += c;
  return text;
}

/// Throws if the unit of a key is not the one that its number is read in.
void check_unit(std::string_view key, std::string_view unit) {
  const std::string plain = plain_unit(unit);
  const auto* known = std::ranges::find(standard_units, key, &UnitsOfKey::key);
  if (plain.empty() || known == std::end(standard_units)) return;
  if (std::ranges::find(known->units, plain) == known->units.end())
    throw RecordError("the unit of " + std::string(key) + " is not " +
                      std::string(known->units[0]) + got(unit));
}

double required_in(const OmmFields& omm, const char* key, double low, double high) {
  return real_in(omm.required(key), key, low, high);
}

double optional_in(const OmmFields& omm, const char* key, double low, double high) {
  const std::string_view text = omm.get(key);
  return text.empty() ? 0.0 : real_in(text, key, low, high);
}

void check_value(const OmmFields& omm, std::string_view key, std::string_view only) {
  const std::string_view text = omm.get(key);
  if (!text.empty() && upper_case(text) != only)
    throw RecordError(std::string(key) + " is not " + std::string(only) + got(text));
}

/// "1998-067A" as a TLE writes it; anything else as it is.
std::string tle_designator(std::string_view id) {
  const auto digits = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (id[i] < '0' || id[i] > '9') return false;
    return true;
  };
  if (id.size() < 9 || id[4] != '-' || !digits(0, 4) || !digits(5, 8)) return std::string(id);
  return std::string(id.substr(2, 2)) + std::string(id.substr(5));
}

}  // namespace

const OmmFields::Field* OmmFields::find(std::string_view key) const {
  const Field* found = nullptr;
  for (const Field& field : fields_) {
    if (field.key != key) continue;
    if (found) throw RecordError(std::string(key) + " is there twice" + got(field.value));
    found = &field;
  }
  return found;
}

std::string_view OmmFields::get(std::string_view key) const {
  const Field* field = find(key);
  if (!field) return {};
  if (!field->other.empty() && field->other != "null")
    throw RecordError(std::string(key) + " is " + field->other + ", not a value");
  check_unit(key, field->unit);
  return trimmed(field->value);
}

std::string_view OmmFields::required(std::string_view key) const {
  const std::string_view text = get(key);
  if (!text.empty()) return text;
  const Field* field = find(key);
  throw RecordError(field && !field->other.empty() ? std::string(key) + " is " + field->other
                                                   : "no " + std::string(key));
}

MeanElements elements_of(const OmmFields& omm) {
  check_value(omm, "CENTER_NAME", "EARTH");
  check_value(omm, "REF_FRAME", "TEME");
  check_value(omm, "TIME_SYSTEM", "UTC");
  const std::string theory = upper_case(omm.get("MEAN_ELEMENT_THEORY"));
  if (!theory.empty() && theory != "SGP4" && theory != "SGP/SGP4" && theory != "SDP4")
    throw RecordError("MEAN_ELEMENT_THEORY is not SGP4" + got(theory));

  MeanElements e;
  const std::string_view number = omm.required("NORAD_CAT_ID");
  const auto catalogue_number = parse_count(number);
  if (!catalogue_number || *catalogue_number > 999'999'999)
    throw RecordError("NORAD_CAT_ID is not a number of up to 9 digits" + got(number));
  e.catalogue_number = *catalogue_number;
  e.name = omm.get("OBJECT_NAME");
  e.designator = tle_designator(omm.get("OBJECT_ID"));
  const auto epoch = parse_iso_epoch(omm.required("EPOCH"));
  if (!epoch) throw RecordError("EPOCH is not a UTC time" + got(omm.get("EPOCH")));
  e.epoch_jd1 = epoch->jd1;
  e.epoch_jd2 = epoch->jd2;
  e.ephemeris_type = count_or_zero(omm.get("EPHEMERIS_TYPE"), "EPHEMERIS_TYPE");
  check_ephemeris_type(e.ephemeris_type);
  const std::string_view classification = omm.get("CLASSIFICATION_TYPE");
  if (!classification.empty()) e.classification = classification[0];
  e.element_number = count_or_zero(omm.get("ELEMENT_SET_NO"), "ELEMENT_SET_NO");
  e.revolution = count_or_zero(omm.get("REV_AT_EPOCH"), "REV_AT_EPOCH");
  e.bstar_per_earth_radius = required_in(omm, "BSTAR", -1e6, 1e6);

  PublishedOrbit orbit;
  orbit.mean_motion_rev_per_day = required_in(omm, "MEAN_MOTION", 1e-8, 100);
  orbit.eccentricity = required_in(omm, "ECCENTRICITY", 0, 1);
  if (orbit.eccentricity == 1) throw RecordError("ECCENTRICITY out of range" + got("1"));
  orbit.inclination_deg = required_in(omm, "INCLINATION", 0, 180);
  orbit.raan_deg = required_in(omm, "RA_OF_ASC_NODE", 0, 360);
  orbit.argument_of_perigee_deg = required_in(omm, "ARG_OF_PERICENTER", 0, 360);
  orbit.mean_anomaly_deg = required_in(omm, "MEAN_ANOMALY", 0, 360);
  orbit.mean_motion_dot_rev_per_day2 = optional_in(omm, "MEAN_MOTION_DOT", -1e3, 1e3);
  orbit.mean_motion_ddot_rev_per_day3 = optional_in(omm, "MEAN_MOTION_DDOT", -1e6, 1e6);
  set_orbit(orbit, e);
  return e;
}

void add_omm(const OmmFields& omm, int line, CatalogueFile& file) {
  try {
    file.elements.push_back(elements_of(omm));
  } catch (const RecordError& error) {
    file.refused.push_back({line, error.what()});
  }
}

}  // namespace dmise
