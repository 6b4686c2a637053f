#include "core/ingest/exposure_times.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/text_fields.h"
#include "core/base/units.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "core/time/leap_seconds.h"

namespace dmise {
namespace {

constexpr double first_mjd = 41330.0, last_mjd = 87900.0;  // 1972 to 2099
constexpr double longest_cube_s = 1e7;

bool in_range(const Utc& time) {
  const double mjd = time.jd1 - mjd_zero_jd;
  return mjd >= first_mjd && mjd < last_mjd;
}

/// Time scale of a header: seconds by which it is ahead of TAI; empty: it is UTC.
struct Scale {
  std::optional<double> ahead_of_tai_s;
  bool known = true;
};

Scale scale_of(const StandardCards& cards) {
  const std::string said = cards.text("TIMESYS");
  const std::string name = upper_case(said.substr(0, said.find('(')));
  if (name.empty() || name == "UTC" || name == "UT" || name == "GMT" || name == "UT1") return {};
  if (name == "TAI" || name == "IAT") return {0.0};
  if (name == "TT" || name == "TDT" || name == "ET" || name == "TDB") return {32.184};
  if (name == "GPS") return {-19.0};
  cards.reject("TIMESYS", "time: is not a known time scale");
  return {std::nullopt, false};
}

Utc to_utc(const Utc& as_told, const Scale& scale) {
  if (!scale.ahead_of_tai_s) return as_told;
  const UtcInstant told = to_instant(as_told);
  const auto ahead_ns = std::int64_t(std::llround(*scale.ahead_of_tai_s * 1e9));
  std::int64_t mjd = told.mjd, ns = told.ns_of_day - ahead_ns;
  for (; ns < 0; ns += ns_per_day) --mjd;
  for (; ns >= ns_per_day; ns -= ns_per_day) ++mjd;
  return to_julian_date(dmise::to_utc(TaiInstant{mjd, ns}));
}

/// The text of a date with more than nine decimals of a second cut off.
std::string nanoseconds_of(std::string text) {
  const std::size_t point = text.find('.');
  if (point == std::string::npos) return text;
  std::size_t end = point + 1;
  while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
  if (end - point > 10) text.erase(point + 10, end - point - 10);
  return text;
}

std::optional<Utc> date_of(const StandardCards& cards, const std::string& key) {
  std::string text = cards.text(key);
  if (text.empty()) return std::nullopt;
  if (text.find(':') == std::string::npos) {  // a date alone
    const auto clock = cards.first_text({"TIME-OBS", "UTC-OBS", "UT", "UTSTART", "UTC"});
    if (!clock || clock->value.find(':') == std::string::npos) {
      cards.reject(key, "time: has no time of day");
      return std::nullopt;
    }
    text += "T" + clock->value;
  }
  try {
    const Utc time = parse_utc(nanoseconds_of(text));
    if (in_range(time)) return time;
  } catch (const Error&) {
  }
  cards.reject(key, "time: is not a date and time of 1972 to 2099");
  return std::nullopt;
}

/// An MJD in the form of a UTC: its fraction counts 86400 s in every scale but UTC, where the day
/// with a leap second is longer.
std::optional<Utc> mjd_of(const StandardCards& cards, const std::string& key, const Scale& scale) {
  const auto mjd = cards.number(key);
  if (!mjd) return std::nullopt;
  if (!(*mjd >= first_mjd && *mjd < last_mjd)) {
    cards.reject(key, "time: must be in 41330..87900");
    return std::nullopt;
  }
  const double day = std::floor(*mjd);
  const double day_share = scale.ahead_of_tai_s ? day_s / utc_day_length_s(std::int64_t(day)) : 1.0;
  return Utc{mjd_zero_jd + day, (*mjd - day) * day_share};
}

/// An instant by DATE-xxx, else MJD-xxx.
std::optional<Utc> instant(const StandardCards& cards, const std::string& which,
                           const Scale& scale) {
  auto told = date_of(cards, "DATE-" + which);
  if (!told) told = mjd_of(cards, "MJD-" + which, scale);
  if (!told) return std::nullopt;
  return to_utc(*told, scale);
}

double seconds_from(const Utc& from, const Utc& to) { return Clock(from).sim_time(to).seconds(); }

std::optional<double> exposure_of(const StandardCards& cards) {
  const auto stated = cards.first_number({"EXPTIME", "EXPOSURE", "XPOSURE"});
  if (!stated) return std::nullopt;
  if (stated->value > 0 && stated->value < 1e6) return stated->value;
  cards.reject(stated->key, "exposure time: must be in (0, 1e6) s");
  return std::nullopt;
}

}  // namespace

Utc later(const Utc& time, double by_s) { return Clock(time).utc(sim_seconds(by_s)); }

ExposureTimes exposure_times(const StandardCards& cards) {
  ExposureTimes out{std::nullopt, exposure_of(cards)};
  const Scale scale = scale_of(cards);
  if (scale.known) {
    const auto begin = instant(cards, "BEG", scale), middle = instant(cards, "AVG", scale),
               end = instant(cards, "END", scale);
    if (!out.exposure_s && begin && end && seconds_from(*begin, *end) > 0) {
      out.exposure_s = seconds_from(*begin, *end);
      cards.assumed("exposure time: from DATE-BEG to DATE-END");
    }
    if (begin) {
      out.start = begin;
    } else if (middle && out.exposure_s) {
      out.start = later(*middle, -*out.exposure_s / 2);
    } else if (end && out.exposure_s) {
      out.start = later(*end, -*out.exposure_s);
    } else if (const auto observed = instant(cards, "OBS", scale)) {
      out.start = observed;
      cards.assumed("time: DATE-OBS or MJD-OBS is taken for the start of the exposure");
    }
  }
  if (!out.exposure_s) cards.missing("exposure time: no EXPTIME, EXPOSURE or XPOSURE");
  if (!out.start) cards.missing("time: no DATE-BEG, DATE-AVG, DATE-END, DATE-OBS or MJD-OBS");
  return out;
}

std::optional<double> seconds_to_plane(const StandardCards& cards, int plane) {
  auto interval = cards.number("KCT");
  if (cards.text("CTYPE3") == "TIME") {
    const std::string unit = cards.text("CUNIT3");
    const double seconds = unit == "d" ? day_s : unit == "min" ? 60.0 : unit == "ms" ? 1e-3 : 1.0;
    interval = cards.number("CDELT3");
    if (interval) *interval *= seconds;
  }
  if (!interval || !(*interval > 0 && *interval * plane < longest_cube_s)) return std::nullopt;
  return *interval * plane;
}

}  // namespace dmise
