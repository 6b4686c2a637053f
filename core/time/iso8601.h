#pragma once
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/time/julian_date.h"

namespace dmise {

/// Thrown for a well-formed time before 1972, when UTC began to differ from TAI by whole seconds.
struct BeforeLeapSeconds : ConfigError {
  using ConfigError::ConfigError;
};

/// Parses `2018-01-20T23:40:00Z`, with up to nine decimals of a second; the `Z` is optional, a
/// blank may replace the `T`, and a date alone means its midnight. `23:59:60` is valid only on days
/// that end with a leap second. Throws `ConfigError` with the reason and the text;
/// `BeforeLeapSeconds` before 1972.
Utc parse_utc(std::string_view text);

/// Formats as `2018-01-20T23:40:00.000Z` with `decimals` in [0, 9] of a second, rounded down so
/// that the text never names a second that has not begun.
std::string format_utc(const Utc& utc, int decimals = 3);

}  // namespace dmise
