#include "core/orbit/sgp4/catalogue_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/sgp4/sgp4_terms.h"

namespace dmise {

namespace {

using sgp4::earth_radius_km;

double period_min(const MeanElements& e) { return 2 * pi / e.mean_motion_rad_per_min; }

std::string line(const char* what, const std::string& value) {
  return formatted("%-22s", what) + value + "\n";
}

// By OrbitRegime.
constexpr std::array regime_names = {"low (< 127 min)", "medium", "geosynchronous",
                                     "elliptic (e >= 0.25)", "beyond"};

}  // namespace

double element_age_days(const MeanElements& elements, const Utc& at) {
  return epoch_days_between({elements.epoch_jd1, elements.epoch_jd2}, at);
}

double semi_major_axis_km(const MeanElements& e) {
  const double n_rad_per_s = e.mean_motion_rad_per_min / 60;
  return std::cbrt(sgp4::mu_km3_per_s2 / (n_rad_per_s * n_rad_per_s));
}

OrbitRegime regime_of(const MeanElements& e) {
  if (e.eccentricity >= 0.25) return OrbitRegime::highly_elliptic;
  if (period_min(e) < 127) return OrbitRegime::low;  // 2000 km
  if (period_min(e) < 1300) return OrbitRegime::medium;
  if (period_min(e) < 1600) return OrbitRegime::geosynchronous;
  return OrbitRegime::beyond;
}

CatalogueReport report_of(const CatalogueFile& file, const std::optional<Utc>& at) {
  CatalogueReport r;
  r.source = file.source;
  r.format = file.format;
  r.records = file.records();
  r.objects = file.elements.size();
  r.refused = file.refused.size();
  r.superseded = file.superseded;
  r.warnings = file.warnings.size();
  for (const MeanElements& e : file.elements) {
    const Utc epoch{e.epoch_jd1, e.epoch_jd2};
    if (!r.oldest_epoch || epoch_days_between(epoch, *r.oldest_epoch) > 0) r.oldest_epoch = epoch;
    if (!r.newest_epoch || epoch_days_between(*r.newest_epoch, epoch) > 0) r.newest_epoch = epoch;
    const double a_km = semi_major_axis_km(e);
    const double perigee_km = a_km * (1 - e.eccentricity) - earth_radius_km;
    const double apogee_km = a_km * (1 + e.eccentricity) - earth_radius_km;
    const bool first = &e == &file.elements.front();
    r.lowest_perigee_km = first ? perigee_km : std::min(r.lowest_perigee_km, perigee_km);
    r.highest_apogee_km = first ? apogee_km : std::max(r.highest_apogee_km, apogee_km);
    r.deep_space += period_min(e) >= 225;
    ++r.by_regime[static_cast<std::size_t>(regime_of(e))];
  }
  if (r.newest_epoch) r.at = at.value_or(*r.newest_epoch);
  for (const MeanElements& e : file.elements)
    r.stale += element_age_days(e, r.at) > stale_after_days;
  for (const auto* problems : {&file.refused, &file.warnings})
    for (const CatalogueProblem& problem : *problems) r.problems.push_back(file.describe(problem));
  return r;
}

std::string format(const CatalogueReport& r, std::size_t problems) {
  std::string text = r.source + ": " + name_of(r.format) + "\n";
  text += line("records", std::to_string(r.records));
  text += line("objects", std::to_string(r.objects));
  text += line("older sets left out", std::to_string(r.superseded));
  text += line("refused", std::to_string(r.refused));
  text += line("read with a warning", std::to_string(r.warnings));
  if (r.oldest_epoch) {
    text += line("oldest epoch", format_iso_epoch(*r.oldest_epoch));
    text += line("newest epoch", format_iso_epoch(*r.newest_epoch));
    text += line("stale", formatted("%zu older than %.0f days at ", r.stale, stale_after_days) +
                              format_iso_epoch(r.at));
    for (std::size_t k = 0; k < regime_names.size(); ++k)
      text += line(regime_names[k], std::to_string(r.by_regime[k]));
    text += line("deep space (SDP4)", std::to_string(r.deep_space));
    text += line("lowest perigee", formatted("%.0f km", r.lowest_perigee_km));
    text += line("highest apogee", formatted("%.0f km", r.highest_apogee_km));
  }
  for (std::size_t k = 0; k < std::min(problems, r.problems.size()); ++k)
    text += r.problems[k] + "\n";
  if (r.problems.size() > problems)
    text += "and " + std::to_string(r.problems.size() - problems) + " more\n";
  return text;
}

}  // namespace dmise
