#pragma once
#include <optional>
#include <string_view>

#include "core/time/julian_date.h"

namespace dmise {

/// A time system in which ephemeris files state their epochs.
struct TimeSystem {
  std::optional<double> tai_minus_s;  // none: UTC
  bool is_tdb = false;                // differs from TT by up to 2 ms more
};

/// UTC, TAI, TT, TDB or GPS, in upper case; nothing for other names.
std::optional<TimeSystem> time_system(std::string_view name);

/// Time of a text that `parse_calendar_time` takes; nothing if it is not such a text.
std::optional<Tai> tai_of(std::string_view text, const TimeSystem& system);

}  // namespace dmise
