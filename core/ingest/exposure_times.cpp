#include "core/ingest/exposure_times.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
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

/// An instant, and the width of the last digit that tells it [s]; 0: as good as its text.
struct ToldTime {
  Utc utc;
  double width_s = 0.0;
};

bool all_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// The parts of a text between a separator.
std::vector<std::string> split_at(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

/// A day as YYYY-MM-DD; also of DD/MM/YY (of 1900 to 1999: FITS Standard 4.0, section 4.4.2.1),
/// DD/MM/YYYY and YYYY/MM/DD. Others are returned as they are.
std::string iso_day(const std::string& day, const StandardCards& cards, const std::string& key) {
  auto parts = split_at(day, '/');
  if (parts.size() != 3 || !std::ranges::all_of(parts, all_digits)) return day;
  if (parts[0].size() == 4) return parts[0] + "-" + parts[1] + "-" + parts[2];
  if (parts[0].size() > 2 || parts[1].size() > 2) return day;
  if (parts[2].size() == 4) {
    if (std::stoi(parts[1]) > 12) std::swap(parts[0], parts[1]);
    cards.assumed("time: " + key + " " + day + " is taken for day " + parts[0] + " of month " +
                  parts[1]);
  } else if (parts[2].size() == 2) {
    parts[2] = "19" + parts[2];
  } else {
    return day;
  }
  for (std::string* part : {&parts[0], &parts[1]})
    if (part->size() == 1) *part = "0" + *part;
  return parts[2] + "-" + parts[1] + "-" + parts[0];
}

/// Takes an offset to UTC (+hh:mm, -hhmm, +hh) from the end of a time of day [s].
double taken_offset_s(std::string& clock) {
  const std::size_t sign = clock.find_first_of("+-");
  if (sign == std::string::npos) return 0.0;
  std::string offset = clock.substr(sign + 1);
  if (offset.size() == 5 && offset[2] == ':') offset.erase(2, 1);
  if (!all_digits(offset) || (offset.size() != 2 && offset.size() != 4)) return 0.0;
  const int minutes =
      60 * std::stoi(offset.substr(0, 2)) + (offset.size() == 4 ? std::stoi(offset.substr(2)) : 0);
  const double way = clock[sign] == '-' ? -60.0 : 60.0;
  clock.erase(sign);
  while (clock.ends_with(' ')) clock.pop_back();
  return way * minutes;
}

/// A time of day as hh:mm:ss with nine decimals at most, without the name of UTC.
std::string plain_clock(std::string clock) {
  for (const char* name : {"Z", "UTC", "UT", "GMT"})
    if (clock.ends_with(name)) {
      clock.erase(clock.size() - std::string_view(name).size());
      break;
    }
  while (clock.ends_with(' ')) clock.pop_back();
  if (clock.size() > 1 && clock[1] == ':') clock = "0" + clock;
  if (clock.size() == 5 && clock[2] == ':') clock += ":00";
  const std::size_t point = clock.find('.');
  if (point == std::string::npos) return clock;
  std::size_t end = point + 1;
  while (end < clock.size() && clock[end] >= '0' && clock[end] <= '9') ++end;
  if (end == point + 1) clock.erase(point, 1);
  if (end - point > 10) clock.erase(point + 10, end - point - 10);
  return clock;
}

/// The cards in which cameras tell a time of day beside a date.
std::optional<StandardCards::Named<std::string>> clock_beside(const StandardCards& cards,
                                                              const std::string& which) {
  if (const auto own = cards.first_text(
          {("TIME-" + which).c_str(), ("UTC-" + which).c_str(), ("UT-" + which).c_str()}))
    return own;
  if (which == "END") return cards.first_text({"UTEND"});
  if (which == "AVG") return std::nullopt;
  return cards.first_text(
      {"TIME-OBS", "UTC-OBS", "UTC_OBS", "UT-OBS", "UT", "UTSTART", "UTC", "TAIHMS"});
}

std::optional<ToldTime> date_of(const StandardCards& cards, const std::string& key,
                                const std::string& which, const Scale& scale) {
  const std::string text = cards.text(key);
  if (text.empty()) return std::nullopt;
  const std::size_t gap = text.find_first_of("T ");
  const std::string day = iso_day(text.substr(0, gap), cards, key);
  const std::size_t after = gap == std::string::npos ? gap : text.find_first_not_of("T ", gap);
  std::string clock = after == std::string::npos ? "" : text.substr(after);
  Scale of_clock = scale;
  if (clock.empty()) {  // a date alone
    const auto beside = clock_beside(cards, which);
    if (!beside || beside->value.find(':') == std::string::npos) {
      cards.reject(key, "time: has no time of day");
      return std::nullopt;
    }
    clock = beside->value;
    if (beside->key == "TAIHMS") of_clock = {0.0};
  }
  const double offset_s = taken_offset_s(clock);
  const std::string plain = plain_clock(clock);
  const double width_s = clock.find(':') == clock.rfind(':') ? 60.0 : 0.0;
  try {
    const Utc told = parse_utc(day + "T" + plain);
    if (in_range(told)) {
      if (offset_s == 0) return ToldTime{to_utc(told, of_clock), width_s};
      cards.assumed(formatted("time: %s has an offset of %+.4g h to UTC, which is taken off",
                              key.c_str(), offset_s / 3600));
      return ToldTime{later(told, -offset_s), width_s};
    }
  } catch (const Error&) {
  }
  cards.reject(key, "time: is not a date and time of 1972 to 2099");
  return std::nullopt;
}

/// The value of one in the last digit of a number's text.
double last_digit(const std::string& text) {
  const std::size_t exponent = text.find_first_of("EeDd"), point = text.find('.');
  const std::string digits = text.substr(0, exponent);
  const double decimals =
      point == std::string::npos || point > digits.size() ? 0.0 : double(digits.size() - point - 1);
  const double power =
      exponent == std::string::npos ? 0.0 : parse_real(text.substr(exponent + 1)).value_or(0.0);
  return std::pow(10.0, power - decimals);
}

/// An MJD in the form of a UTC: its fraction counts 86400 s in every scale but UTC, where the day
/// with a leap second is longer.
std::optional<ToldTime> mjd_of(const StandardCards& cards, const std::string& key,
                               const Scale& scale) {
  const auto mjd = cards.number(key);
  if (!mjd) return std::nullopt;
  if (!(*mjd >= first_mjd && *mjd < last_mjd)) {
    cards.reject(key, "time: must be in 41330..87900");
    return std::nullopt;
  }
  const double day = std::floor(*mjd);
  const double day_share = scale.ahead_of_tai_s ? day_s / utc_day_length_s(std::int64_t(day)) : 1.0;
  return ToldTime{to_utc(Utc{mjd_zero_jd + day, (*mjd - day) * day_share}, scale),
                  day_s * last_digit(cards.text(key))};
}

/// An instant by DATE-xxx, else MJD-xxx. A width that may be seen is noted.
std::optional<ToldTime> instant(const StandardCards& cards, const std::string& which,
                                const Scale& scale) {
  constexpr double min_noted_s = 0.01;
  for (const std::string sign : {"-", "_"}) {
    std::string key = "DATE" + sign + which;
    auto told = date_of(cards, key, which, scale);
    if (!told) {
      key = "MJD" + sign + which;
      told = mjd_of(cards, key, scale);
    }
    if (!told) continue;
    if (told->width_s > min_noted_s)
      cards.assumed(formatted("time: the last digit of %s is %.3g s: no time is known better",
                              key.c_str(), told->width_s));
    return told;
  }
  return std::nullopt;
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
  ExposureTimes out{.start = std::nullopt, .exposure_s = exposure_of(cards)};
  const Scale scale = scale_of(cards);
  if (scale.known) {
    const auto begin = instant(cards, "BEG", scale), middle = instant(cards, "AVG", scale),
               end = instant(cards, "END", scale);
    const auto start_at = [&](const ToldTime& told, double before_s) {
      out.start = later(told.utc, -before_s);
      out.width_s = told.width_s;
    };
    if (!out.exposure_s && begin && end && seconds_from(begin->utc, end->utc) > 0) {
      out.exposure_s = seconds_from(begin->utc, end->utc);
      cards.assumed("exposure time: from DATE-BEG to DATE-END");
    }
    if (begin) {
      start_at(*begin, 0.0);
    } else if (middle && out.exposure_s) {
      start_at(*middle, *out.exposure_s / 2);
    } else if (const auto observed = instant(cards, "OBS", scale)) {
      start_at(*observed, 0.0);
      cards.assumed("time: DATE-OBS or MJD-OBS is taken for the start of the exposure");
    } else if (end && out.exposure_s) {
      start_at(*end, *out.exposure_s);
    }
  }
  if (!out.exposure_s) cards.missing("exposure time: no EXPTIME, EXPOSURE or XPOSURE");
  if (!out.start) cards.missing("time: no DATE-BEG, DATE-AVG, DATE-OBS, MJD-OBS or DATE-END");
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
