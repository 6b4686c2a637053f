#include "core/orbit/time_system.h"

#include <erfa.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/units.h"
#include "core/orbit/elements/epoch.h"

namespace dmise {
namespace {

constexpr std::pair<std::string_view, TimeSystem> time_systems[] = {
    {"UTC", {}}, {"TAI", {0.0}}, {"TT", {-32.184}}, {"GPS", {19.0}}, {"TDB", {-32.184, true}}};

std::optional<Tai> tai_of_utc(std::string_view text) {
  const auto utc = parse_iso_epoch(text);
  Tai tai;
  if (!utc || eraUtctai(utc->jd1, utc->jd2, &tai.jd1, &tai.jd2) < 0) return std::nullopt;
  return tai;
}

}  // namespace

std::optional<TimeSystem> time_system(std::string_view name) {
  const auto* known = std::ranges::find(time_systems, name, [](const auto& s) { return s.first; });
  if (known == std::end(time_systems)) return std::nullopt;
  return known->second;
}

std::optional<Tai> tai_of(std::string_view text, const TimeSystem& system) {
  if (!system.tai_minus_s) return tai_of_utc(text);
  const auto time = parse_calendar_time(text);
  if (!time) return std::nullopt;
  const double of_day = time->second_of_day / day_s;
  const double tdb_minus_tt_s =
      system.is_tdb ? eraDtdb(time->midnight_jd, of_day, of_day, 0.0, 0.0, 0.0) : 0.0;
  return Tai{time->midnight_jd,
             (time->second_of_day + *system.tai_minus_s - tdb_minus_tt_s) / day_s};
}

}  // namespace dmise
