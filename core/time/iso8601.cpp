#include "core/time/iso8601.h"

#include <erfa.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/time/leap_seconds.h"

namespace dmise {
namespace {

// Parses the text from the left; every error quotes the whole text.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text), rest_(text) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw ConfigError("not a UTC time: " + reason + ", got \"" + std::string(text_) + "\"");
  }
  bool at_end() const { return rest_.empty(); }
  bool take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c)) fail(std::string("expected '") + c + "'");
  }
  int number(int digits) {
    int value = 0;
    for (int i = 0; i < digits; ++i) value = 10 * value + digit();
    return value;
  }
  /// Digits after the decimal point, as nanoseconds.
  std::int64_t nanoseconds() {
    std::int64_t value = digit();
    int digits = 1;
    while (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
      if (++digits > 9) fail("more than nine decimals");
      value = 10 * value + digit();
    }
    for (; digits < 9; ++digits) value *= 10;
    return value;
  }

 private:
  int digit() {
    if (rest_.empty() || rest_.front() < '0' || rest_.front() > '9') fail("expected a digit");
    const int value = rest_.front() - '0';
    rest_.remove_prefix(1);
    return value;
  }

  std::string_view text_, rest_;
};

}  // namespace

Utc parse_utc(std::string_view text) {
  Reader in(text);
  const int year = in.number(4);
  in.expect('-');
  const int month = in.number(2);
  in.expect('-');
  const int day = in.number(2);
  double zero = 0.0, mjd = 0.0;
  if (eraCal2jd(year, month, day, &zero, &mjd) != 0) in.fail("day does not exist");
  if (year < 1972)
    throw BeforeLeapSeconds(
        "not a UTC time: before 1972, when UTC was not yet whole seconds from TAI, got \"" +
        std::string(text) + "\"");
  UtcInstant utc{static_cast<std::int64_t>(mjd), 0};
  if (in.at_end()) return to_julian_date(utc);

  if (!in.take('T') && !in.take(' ')) in.fail("expected 'T'");
  const int hour = in.number(2);
  in.expect(':');
  const int minute = in.number(2);
  in.expect(':');
  const int second = in.number(2);
  const std::int64_t ns = in.take('.') ? in.nanoseconds() : 0;
  in.take('Z');
  if (!in.at_end()) in.fail("text after the time");
  if (hour > 23 || minute > 59 || second > 60) in.fail("time of day does not exist");
  const std::int64_t second_of_day = (hour * 60 + minute) * 60 + second;
  if (second == 60 && (second_of_day != 86400 || utc_day_length_s(utc.mjd) != 86401))
    in.fail("no leap second at that time");
  utc.ns_of_day = second_of_day * ns_per_s + ns;
  return to_julian_date(utc);
}

std::string format_utc(const Utc& utc, int decimals) {
  const UtcInstant instant = to_instant(utc);
  int year = 0, month = 0, day = 0;
  double fraction = 0.0;
  eraJd2cal(mjd_zero_jd, static_cast<double>(instant.mjd), &year, &month, &day, &fraction);
  const std::int64_t second_of_day = instant.ns_of_day / ns_per_s;
  const std::int64_t minute_of_day = std::min<std::int64_t>(second_of_day / 60, 1439);
  std::string text = formatted(
      "%04d-%02d-%02dT%02d:%02d:%02d.%09d", year, month, day, static_cast<int>(minute_of_day / 60),
      static_cast<int>(minute_of_day % 60), static_cast<int>(second_of_day - 60 * minute_of_day),
      static_cast<int>(instant.ns_of_day % ns_per_s));
  decimals = std::clamp(decimals, 0, 9);
  text.resize(text.size() - std::size_t(decimals > 0 ? 9 - decimals : 10));  // the point, too
  return text + "Z";
}

}  // namespace dmise
