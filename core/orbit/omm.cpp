#include "core/orbit/omm.h"

#include "core/base/text_fields.h"
#include "core/orbit/epoch.h"

namespace dmise {

namespace {

std::string_view required(const OmmFields& omm, std::string_view key) {
  const std::string_view text = omm.get(key);
  if (text.empty()) throw RecordError("no " + std::string(key));
  return text;
}

double required_in(const OmmFields& omm, const char* key, double low, double high) {
  return real_in(required(omm, key), key, low, high);
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

std::string_view OmmFields::get(std::string_view key) const {
  for (const auto& [name, value] : fields_)
    if (name == key) return trimmed(value);
  return {};
}

MeanElements elements_of(const OmmFields& omm) {
  check_value(omm, "CENTER_NAME", "EARTH");
  check_value(omm, "REF_FRAME", "TEME");
  check_value(omm, "TIME_SYSTEM", "UTC");
  const std::string theory = upper_case(omm.get("MEAN_ELEMENT_THEORY"));
  if (!theory.empty() && theory != "SGP4" && theory != "SGP/SGP4" && theory != "SDP4")
    throw RecordError("MEAN_ELEMENT_THEORY is not SGP4" + got(theory));

  MeanElements e;
  const std::string_view number = required(omm, "NORAD_CAT_ID");
  const auto catalogue_number = parse_count(number);
  if (!catalogue_number || *catalogue_number > 999'999'999)
    throw RecordError("NORAD_CAT_ID is not a number of up to 9 digits" + got(number));
  e.catalogue_number = *catalogue_number;
  e.name = omm.get("OBJECT_NAME");
  e.designator = tle_designator(omm.get("OBJECT_ID"));
  const auto epoch = parse_iso_epoch(required(omm, "EPOCH"));
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
